// SPDX-License-Identifier: Apache-2.0
// Lists with filters. Their state is the fragment of the address, so each state can be linked to and gone back to.
const FEW = 8;

// Facets: name, label and the values of a row. `order` lists the values as they are shown.
const itemFacets = [
  { name: "level", label: "Level", of: (i) => [items.level[i]], order: data.levels.map(([key]) => key), title: (key) => levelNames.get(key) },
  { name: "verdict", label: "Verdict", of: (i) => [wordOf(i)], order: [...data.verdicts].reverse() },
  { name: "sil", label: "SIL", of: (i) => [items.sil[i] || "none"], order: [...data.sil, "none"] },
  { name: "verify", label: "Verified by", of: (i) => (items.verify[i].length ? items.verify[i] : ["nothing"]) },
  { name: "status", label: "Status", of: (i) => [items.status[i] || "none"] },
  { name: "area", label: "Area", of: (i) => [items.area[i] || "none"] },
];
const findingFacets = [
  { name: "severity", label: "Severity", of: (f) => [data.findings.severity[f]], order: ["error", "warning"] },
  { name: "rule", label: "Rule", of: (f) => [data.findings.rule[f]], select: true },
  { name: "file", label: "File", of: (f) => [data.files[data.findings.file[f]]], select: true },
];
const resultFacets = [
  { name: "status", label: "Result", of: (r) => [r.status], order: ["failed", "skipped", "unbound", "not run", "not shown here", "passed"] },
  { name: "kind", label: "Kind", of: (r) => [r.kind] },
  { name: "polarity", label: "Polarity", of: (r) => [r.polarity] },
  { name: "technique", label: "Technique", of: (r) => [r.technique], select: true },
];

const chosenOf = (query, facet) => new Set(query.getAll(facet.name));
const termsOf = (query) => (query.get("q") || "").toLowerCase().split(/\s+/).filter(Boolean);

// Rows that fit, and for each facet how many rows each value would leave, the other filters as they are.
function sift(rows, facets, query, textOf) {
  const terms = termsOf(query);
  const chosen = facets.map((facet) => chosenOf(query, facet));
  const counts = facets.map(() => new Map());
  const fitting = [];
  for (const row of rows) {
    if (terms.length) { const text = textOf(row); if (!terms.every((term) => text.includes(term))) continue; }
    let misses = 0;
    let missed = -1;
    const values = facets.map((facet) => facet.of(row));
    for (let f = 0; f < facets.length && misses < 2; f++) {
      if (chosen[f].size && !values[f].some((value) => chosen[f].has(value))) { misses++; missed = f; }
    }
    if (misses === 0) fitting.push(row);
    if (misses < 2) values.forEach((list, f) => { if (misses === 0 || missed === f) for (const value of list) counts[f].set(value, (counts[f].get(value) || 0) + 1); });
  }
  return { fitting, counts };
}

// The form of the filters. `change(query)` is called with the new state.
function filterForm(view, facets, all, query, counts, change) {
  const read = () => {
    const state = new URLSearchParams();
    for (const field of form.elements) {
      if (field.name && field.value && (field.type !== "checkbox" || field.checked)) state.append(field.name, field.value);
    }
    if (query.get("sort")) state.set("sort", query.get("sort"));
    return state;
  };
  const text = make("input", { type: "search", name: "q", "aria-label": "Words in id, title or text", placeholder: "Filter by words", value: query.get("q") || "", autocomplete: "off" });
  const form = make("form", { class: "filter", "aria-label": "Filters", onsubmit: (event) => event.preventDefault() },
    make("div", { class: "line" }, text, make("button", { type: "button", onclick: () => change(new URLSearchParams()), hidden: !query.size }, "Clear filters"),
      make("output", { "aria-live": "polite" })),
    facets.map((facet, f) => drawFacet(facet, all[f], chosenOf(query, facet), counts[f])));
  form.addEventListener("input", () => change(read()));
  return form;
}

function drawFacet(facet, all, chosen, counts) {
  const known = (facet.order || []).filter((value) => all.has(value));
  const values = [...known, ...[...all].filter((value) => !known.includes(value)).sort()];
  if (values.length < 2 && !chosen.size) return null;
  if (values.length > FEW || facet.select) {
    return make("label", { class: "pick" }, facet.label, make("select", { name: facet.name }, make("option", { value: "" }, `any (${values.length})`),
      values.map((value) => make("option", { value, selected: chosen.has(value) }, `${value} (${(counts.get(value) || 0).toLocaleString("en")})`))));
  }
  return make("fieldset", {}, make("legend", {}, facet.label), values.map((value) =>
    make("label", { class: `chip${counts.get(value) ? "" : " none"}`, title: facet.title && facet.title(value) },
      make("input", { type: "checkbox", name: facet.name, value, checked: chosen.has(value) }), make("span", {}, value, make("b", {}, (counts.get(value) || 0).toLocaleString("en"))))));
}

// A view of filtered rows: keeps the text field under the hands of the user while everything else is drawn anew.
function filteredView(view, facets, listRows, textOf, drawList) {
  const holder = document.querySelector(`#${view} > .drawn`);
  if (!holder) return { show: () => undefined };
  const getAll = later(() => {
    const all = facets.map(() => new Set());
    for (const row of listRows()) facets.forEach((facet, f) => facet.of(row).forEach((value) => all[f].add(value)));
    return all;
  });
  const state = { fitting: [] };
  const show = (query) => {
    const { fitting, counts } = sift(listRows(), facets, query, textOf);
    state.fitting = fitting;
    const form = filterForm(view, facets, getAll(), query, counts, (next) => { history.replaceState(null, "", viewAddress(view, listFilters(next))); show(next); });
    form.querySelector("output").textContent = `${fitting.length.toLocaleString("en")} of ${listRows().length.toLocaleString("en")}`;
    const list = drawList(fitting, query, (sort) => { query.set("sort", sort); history.replaceState(null, "", viewAddress(view, listFilters(query))); show(query); });
    const held = holder.contains(document.activeElement) ? document.activeElement : null;
    const caret = held && held.type === "search" ? held.selectionStart : null;
    const like = held && held.name ? [...form.elements].find((field) => field.name === held.name && (field.type !== "checkbox" || field.value === held.value)) : null;
    holder.replaceChildren(form, fitting.length ? list : make("p", { class: "empty" }, "Nothing fits these filters."));
    holder.hidden = false;
    if (like) { like.focus(); if (caret !== null) like.setSelectionRange(caret, caret); }
  };
  state.show = show;
  return state;
}

const listFilters = (query) => Object.fromEntries([...new Set(query.keys())].map((name) => [name, query.getAll(name)]));

const columns = [
  ["id", "Item", (i) => i],
  ["sil", "SIL", (i) => data.sil.indexOf(items.sil[i])],
  ["from", "Parents", (i) => items.parents[i].map((parent) => items.id[parent] || parent).join(" ")],
  ["verify", "Verified by", (i) => items.verify[i].join(" ")],
  ["code", "Code", (i) => rowsOf(getTags, i).length],
  ["tests", "Tests", (i) => countTests(i)[1]],
  ["cases", "Cases", (i) => rowsOf(getCases, i).length],
  ["verdict", "Verdict", (i) => items.verdict[i]],
];

function countTests(number) {
  const results = rowsOf(getResults, number);
  return [results.filter((row) => data.results.status[row] === "passed").length, results.length + rowsOf(getUnexecuted, number).length];
}

function drawMatrixRow(i) {
  const [passed, all] = countTests(i);
  const cases = rowsOf(getCases, i);
  const good = cases.filter((each) => each.status === "passed").length;
  const failing = rowsOf(getResults, i).length > passed;
  return make("tr", {},
    make("td", { class: "title" }, itemLink(i), items.title[i]),
    make("td", { "data-name": "SIL" }, items.sil[i]),
    make("td", { class: "ids", "data-name": items.parents[i].length ? "from" : null }, items.parents[i].map((parent) => itemLink(parent))),
    make("td", { class: "words-of" }, items.verify[i].join(", ")),
    make("td", { class: "num", "data-name": "code" }, rowsOf(getTags, i).length || ""),
    make("td", { class: failing ? "num bad" : "num", "data-name": "tests" }, all ? `${passed}/${all}` : ""),
    make("td", { class: good < cases.length ? "num bad" : "num", "data-name": "cases" }, cases.length ? `${good}/${cases.length}` : ""),
    make("td", {}, badge(wordOf(i))));
}

function drawMatrix(rows, query, sortBy) {
  const [by, down] = (query.get("sort") || "").split("-");
  const column = columns.find(([name]) => name && name === by);
  if (column) {
    const key = column[2];
    rows.sort((a, b) => { const x = key(a); const y = key(b); return (x < y ? -1 : x > y ? 1 : a - b) * (down ? -1 : 1); });
  }
  const head = columns.map(([name, label], at) => {
    const isBy = column && name === by;
    return make("th", { scope: "col", class: at >= 4 && at <= 6 ? "num" : null, "aria-sort": isBy ? (down ? "descending" : "ascending") : null },
      name ? make("button", { type: "button", class: "bare", onclick: () => sortBy(isBy && !down ? `${name}-down` : name) }, label) : label);
  });
  const table = make("table", { class: "rows" }, make("thead", {}, make("tr", {}, head)), make("tbody"));
  return growing(table, rows, 100, drawMatrixRow, "item");
}

const allItems = later(() => items.id.map((_, number) => number));
const matrix = filteredView("matrix", itemFacets, allItems, (i) => getSearchTexts()[i], drawMatrix);
