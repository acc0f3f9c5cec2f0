// SPDX-License-Identifier: Apache-2.0
// Findings, test results and code.
const allFindings = later(() => data.findings.rule.map((_, row) => row));
const aboutRule = new Map(data.rules.map(([id, , about]) => [id, about]));

const findingText = later(() => allFindings().map((f) => {
  const item = data.findings.item[f];
  return `${data.findings.message[f]} ${data.findings.rule[f]} ${placeOf(data.findings, f)} ${typeof item === "number" ? items.id[item] : item}`.toLowerCase();
}));

function drawFinding(row) {
  const item = data.findings.item[row];
  return make("li", {}, data.findings.message[row],
    make("div", { class: "under" }, code(placeOf(data.findings, row)), typeof item === "number" ? itemLink(item) : null));
}

function drawFindings(rows) {
  const groups = groupBy(rows.map((row) => data.findings.rule[row]));
  const order = data.rules.map(([id]) => id).filter((id) => groups.has(id));
  const rest = [...groups.keys()].filter((id) => !order.includes(id));
  const ordered = [...order, ...rest].map((rule) => [rule, groups.get(rule).map((at) => rows[at])]);
  const weigh = ([, group]) => (data.findings.severity[group[0]] === "error" ? 0 : 1);
  ordered.sort((a, b) => weigh(a) - weigh(b));
  return make("div", {}, ordered.map(([rule, group]) => make("div", { class: "group" },
    make("h2", {}, code(rule, ""), badge(data.findings.severity[group[0]]), quiet(group.length.toLocaleString("en"))),
    make("p", { class: "quiet" }, aboutRule.get(rule) || ""),
    growing(make("ul", { class: "findings" }), group, 50, drawFinding, "finding"))));
}

// Results, and the tests that left none.
const allResults = later(() => [
  ...data.results.name.map((name, row) => ({
    row, name, suite: data.results.suites[data.results.suite[row]], kind: data.results.kind[row], status: resultWord(row),
    polarity: data.results.polarity[row], technique: data.results.technique[row].replaceAll("_", " "), item: data.results.item[row],
    message: data.results.message[row], place: placeOf(data.results, row), time: data.results.time[row],
  })),
  ...data.unexecuted.title.map((title, row) => ({
    row: -1, name: title, suite: "Tests without a result", kind: "in the sources", status: "not run", polarity: data.unexecuted.polarity[row],
    technique: data.unexecuted.technique[row].replaceAll("_", " "), item: data.unexecuted.item[row], message: "",
    place: placeOf(data.unexecuted, row), time: 0,
  })),
]);
const resultText = (result) => `${result.suite}.${result.name} ${typeof result.item === "number" ? items.id[result.item] : result.item} ${result.place}`.toLowerCase();

function drawResultRow(result) {
  return make("tr", {},
    make("td", { class: "title" }, breakable(result.name), result.message ? make("div", { class: "quiet pre" }, result.message) : null),
    make("td", {}, result.item === "" ? "" : itemLink(result.item)),
    make("td", { class: "words-of" }, result.polarity), make("td", { class: "words-of" }, result.technique), make("td", {}, badge(result.status)));
}

const SUITES_STEP = 40;
function drawTests(rows) {
  const groups = [...groupBy(rows.map((result) => `${result.kind}\n${result.suite}`)).values()].map((group) => group.map((at) => rows[at]));
  const rank = { failed: 0, skipped: 1, unbound: 2, "not run": 3, "not shown here": 4, passed: 5 };
  const worst = (group) => group.reduce((word, result) => (rank[result.status] < rank[word] ? result.status : word), "passed");
  const suites = groups.map((group) => [group, worst(group)]).sort((a, b) => rank[a[1]] - rank[b[1]]);
  const draw = ([group, word]) => {
    const fold = make("details", { class: "fold" }, make("summary", {},
      make("span", { class: "grow" }, group[0].suite, " ", quiet(group[0].kind)),
      quiet(group.length.toLocaleString("en"), group[0].row < 0 ? "" : ` in ${group.reduce((sum, result) => sum + result.time, 0).toFixed(2)} s`), badge(word)));
    const fill = later(() => fold.append(make("div", { class: "body" }, growing(
      make("table", { class: "rows small" }, heads(["Test", "Verifies", "Polarity", "Technique", "Result"]), make("tbody")), group, 100, drawResultRow, "test"))) || true);
    fold.addEventListener("toggle", fill);
    if (suites.length <= 3 || (word === "failed" && suites.indexOf(group) < 5)) fold.open = true;
    return fold;
  };
  return growing(make("div"), suites, SUITES_STEP, draw, "suite");
}

const codeFacets = [{ name: "folder", label: "Folder", of: (file) => [file.name.split("/")[0]], select: true }];
const allFiles = later(() => [...groupBy(data.tags.file)].map(([file, rows]) => ({ name: data.files[file], rows })));
const codeText = (file) => `${file.name} ${file.rows.map((row) => `${typeof data.tags.item[row] === "number" ? items.id[data.tags.item[row]] : data.tags.item[row]} ${data.tags.symbol[row]}`).join(" ")}`.toLowerCase();

function drawCode(files) {
  const row = (file) => make("tr", {}, make("td", { class: "title" }, code(file.name, "")), make("td", { class: "ids" }, file.rows.map((at) => [
    itemLink(data.tags.item[at]), data.tags.symbol[at] === "file" ? null : [quiet(data.tags.symbol[at]), " "]])));
  return growing(make("table", { class: "rows" }, heads(["File", "Satisfies"]), make("tbody")), files, 100, row, "file");
}

const findings = filteredView("findings", findingFacets, allFindings, (f) => findingText()[f], drawFindings);
const tests = filteredView("tests", resultFacets, allResults, resultText, drawTests);
const codeView = filteredView("code", codeFacets, allFiles, codeText, drawCode);
