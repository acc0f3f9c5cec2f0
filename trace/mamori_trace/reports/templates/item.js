// SPDX-License-Identifier: Apache-2.0
// The page of one item: what it demands, the chain from hazard to result, and everything that names it.
const CHAIN_FEW = 7;

function drawItem(number, neighbours) {
  const word = wordOf(number);
  const reasons = items.reasons[number];
  return [
    drawTrail(number, neighbours),
    make("div", { class: "item-head" }, make("h1", {}, make("span", { class: "id" }, items.id[number]), items.title[number]), badge(word)),
    make("div", { class: "badges" }, drawFacts(number)),
    make("p", { class: "statement" }, items.statement[number]),
    items.rationale[number] ? make("p", { class: "quiet" }, items.rationale[number]) : null,
    reasons.length ? make("div", { class: `against ${css(word)}` }, make("h2", {}, `Why the verdict is “${word}”`), make("ul", {}, drawSome(reasons, 8, (reason) => make("li", {}, reason)))) : null,
    make("h2", {}, "Chain from hazard to result"),
    drawChain(number),
    drawItemTests(number),
    make("div", { class: "columns" }, drawCases(number), drawTags(number)),
    drawCoverage(number),
    drawItemFindings(number),
    drawHistory(number),
  ].filter(Boolean);
}

function drawTrail(number, [before, after]) {
  const step = (other, label, key) => (other === undefined ? null : make("a", { class: "step", href: itemAddress(items.id[other]), "aria-keyshortcuts": key, title: `${items.id[other]} ${items.title[other]}` }, label));
  return make("div", { class: "trail" }, make("span", { class: "grow" }, make("a", { class: "step", href: `#matrix${lastMatrix}` }, "← Matrix"), " ",
    quiet(levelNames.get(items.level[number]) || items.level[number])), step(before, "← before", "["), step(after, "next →", "]"));
}

function drawFacts(number) {
  const fact = (text) => make("span", { class: "badge plain" }, text);
  return [items.sil[number] && fact(/^\d/.test(items.sil[number]) ? `SIL ${items.sil[number]}` : items.sil[number]), fact(items.status[number] || "no status"),
    fact(`verify: ${items.verify[number].join(", ") || "–"}`), fact(`polarity: ${items.polarity[number].join(", ") || "–"}`),
    items.design[number] && code(items.design[number]), code(placeOf(items, number))].filter(Boolean);
}

// The first `few` of a list, and a button that shows the others in their place.
function drawSome(rows, few, draw) {
  const shown = rows.length > few + 1 ? rows.slice(0, few) : rows;
  const elements = shown.map(draw);
  if (shown.length < rows.length) {
    const button = make("button", { type: "button" }, `${(rows.length - few).toLocaleString("en")} more`);
    const last = make("li", { class: "rest" }, button);
    button.addEventListener("click", () => last.replaceWith(...rows.slice(few, few + 500).map(draw)));
    elements.push(last);
  }
  return elements;
}

function drawChain(number) {
  const above = listAbove(number);
  const below = listBelow(number);
  const family = [number, ...below];
  const related = [...above, number, ...below];
  const columns = data.levels.map(([key, name]) => [name, related.filter((i) => items.level[i] === key).sort((a, b) => (b === number) - (a === number) || items.verdict[b] - items.verdict[a] || a - b)]);
  const drawn = columns.filter(([, rows]) => rows.length).map(([name, rows]) => drawColumn(name, rows.length, drawSome(rows, CHAIN_FEW, (i) => drawLink(i, number))));
  const files = new Map();
  for (const i of family) for (const row of rowsOf(getTags, i)) if (!files.has(data.tags.file[row])) files.set(data.tags.file[row], row);
  if (files.size) drawn.push(drawColumn("Code", files.size, drawSome([...files.keys()].sort((a, b) => a - b), CHAIN_FEW, (file) => make("li", {}, drawFile(data.files[file])))));
  const shown = listShown(family);
  if (shown.length) drawn.push(drawColumn("Results", shown.length, drawSome(shown, CHAIN_FEW, drawShown)));
  return make("div", { class: "chain", role: "group", tabindex: "0", "aria-label": "Chain from hazard to result" }, drawn);
}

const drawColumn = (name, size, rows) => make("div", { class: "column" }, make("h3", {}, size > 1 ? `${name}, ${size.toLocaleString("en")}` : name), make("ul", {}, rows));

function drawLink(i, number) {
  const parts = [make("span", { class: "id" }, items.id[i]), items.title[i]];
  if (i === number) return make("li", {}, make("span", { class: `self ${css(wordOf(i))}`, "aria-current": "true" }, parts));
  return make("li", {}, make("a", { class: css(wordOf(i)), href: itemAddress(items.id[i]), "aria-label": `${items.id[i]} ${items.title[i]}, ${wordOf(i)}` }, parts));
}

function drawFile(file) {
  const at = file.lastIndexOf("/") + 1;
  return make("a", { href: viewAddress("code", { q: file }) }, breakable(file.slice(at)), make("span", { class: "under" }, breakable(file.slice(0, at))));
}

function drawShown([word, suite, name, href]) {
  return make("li", {}, make("a", { class: css(word), href }, breakable(name), make("span", { class: "under" }, suite ? `${suite}, ${word}` : word)));
}

// Results and cases of some items, the worst first: word, suite, name, address.
function listShown(numbers) {
  const rank = { failed: 0, skipped: 1, unbound: 2, "not run": 3, "not shown here": 4, passed: 5 };
  const shown = [];
  for (const i of numbers) {
    for (const row of rowsOf(getResults, i)) shown.push([resultWord(row), data.results.suites[data.results.suite[row]], data.results.name[row], viewAddress("tests", { q: `${data.results.suites[data.results.suite[row]]}.${data.results.name[row]}` })]);
    for (const row of rowsOf(getUnexecuted, i)) shown.push(["not run", "", data.unexecuted.title[row], viewAddress("tests", { q: data.unexecuted.title[row], status: "not run" })]);
    for (const each of rowsOf(getCases, i)) shown.push([each.status, "campaign", each.id, `#${each.anchor}`]);
  }
  return shown.sort((a, b) => rank[a[0]] - rank[b[0]]);
}

function drawItemTests(number) {
  const rows = [
    ...rowsOf(getResults, number).map((row) => [`${data.results.suites[data.results.suite[row]]}.${data.results.name[row]}`, data.results.kind[row], data.results.technique[row], data.results.polarity[row], placeOf(data.results, row), data.results.status[row], data.results.message[row]]),
    ...rowsOf(getUnexecuted, number).map((row) => [data.unexecuted.title[row], "", data.unexecuted.technique[row], data.unexecuted.polarity[row], placeOf(data.unexecuted, row), "not run", ""]),
  ];
  if (!rows.length) return null;
  const draw = ([title, kind, technique, polarity, place, status, message]) => make("tr", {},
    make("td", { class: "title" }, breakable(title), message ? make("div", { class: "quiet pre" }, message.split("\n")[0]) : null),
    make("td", { class: "words-of" }, kind), make("td", { class: "words-of" }, technique.replaceAll("_", " ")), make("td", { class: "words-of" }, polarity),
    make("td", {}, code(place)), make("td", {}, badge(status)));
  const table = make("table", { class: "rows small" }, heads(["Test", "Kind", "Technique", "Polarity", "Source", "Result"]), make("tbody"));
  return make("div", {}, make("h2", {}, "Tests"), growing(table, rows, 50, draw, "test"));
}

function drawCases(number) {
  const cases = rowsOf(getCases, number);
  if (!cases.length) return null;
  return make("div", {}, make("h2", {}, "Campaign cases"), make("ul", { class: "plain" }, drawSome(cases, 20, (each) => make("li", {},
    make("a", { href: `#${each.anchor}` }, each.id), " ", quiet(each.polarity), " ", badge(each.status)))));
}

function drawTags(number) {
  const rows = rowsOf(getTags, number);
  if (!rows.length) return null;
  return make("div", {}, make("h2", {}, "Code"), make("ul", { class: "plain" }, drawSome(rows, 20, (row) => make("li", {}, code(placeOf(data.tags, row)),
    data.tags.symbol[row] === "file" ? null : [" ", code(data.tags.symbol[row], "")]))));
}

function drawCoverage(number) {
  const rows = data.coverage[number];
  if (!rows) return null;
  const part = ([covered, all]) => (all ? [`${covered}/${all}`, make("span", { class: `meter ${covered === all ? "passed" : "incomplete"}` }, make("i", { style: `width:${(100 * covered) / all}%` }))] : quiet("–"));
  const draw = ([symbol, file, line, executed, lines, branches, conditions, gaps, accepted]) => make("tr", {},
    make("td", { class: "title" }, code(symbol, ""), " ", code(`${data.files[file]}:${line}`), gaps.map((gap) => drawGap(data.files[file], gap))),
    make("td", {}, executed === null ? quiet("not measured") : badge(executed ? "passed" : accepted ? "draft" : "failed", executed ? "executed" : "never executed"), accepted ? make("div", { class: "quiet" }, accepted) : null),
    [["lines", lines], ["branches", branches], ["MC/DC", conditions]].map(([name, pair]) => make("td", { "data-name": name }, part(pair))));
  const table = make("table", { class: "rows small" }, heads(["Function", "By its tests", "Lines", "Branches", "MC/DC"]), make("tbody"));
  return make("div", {}, make("h2", {}, "Coverage by the tests that verify it"), growing(table, rows, 50, draw, "function"));
}

// A condition that no test has shown to decide alone.
const drawGap = (file, [line, text, reason]) => make("div", { class: "quiet" }, "MC/DC not shown: ", code(text, ""), " ", code(`${file}:${line}`), reason ? ` accepted: ${reason}` : "");

function drawItemFindings(number) {
  const rows = rowsOf(getFindings, number);
  if (!rows.length) return null;
  return make("div", {}, make("h2", {}, "Findings"), make("ul", { class: "findings" }, drawSome(rows, 20, (row) => make("li", {}, badge(data.findings.severity[row]), " ", data.findings.message[row],
    make("div", { class: "under" }, make("a", { href: viewAddress("findings", { rule: data.findings.rule[row] }) }, data.findings.rule[row]), code(placeOf(data.findings, row)))))));
}

function drawHistory(number) {
  const changes = data.history[number];
  if (!changes) return null;
  return make("div", {}, make("h2", {}, "History"), make("ul", { class: "plain history" }, drawSome(changes, 8, (at) => {
    const [hash, date, subject] = data.commits[at];
    return make("li", {}, make("time", { datetime: date }, date), code(hash, ""), make("span", {}, subject));
  })));
}
