// SPDX-License-Identifier: Apache-2.0
// The data of the page, and what follows from it. Items are numbers, their place in each column of `items`.
const data = JSON.parse(document.getElementById("data").textContent);
const items = data.items;
const itemCount = items.id.length;
const numberOf = new Map(items.id.map((id, number) => [id, number]));

// Made when first asked for: most visits look at a few views.
const later = (make) => { let made; return () => (made === undefined ? (made = make()) : made); };

function groupBy(column, keep = () => true) {
  const groups = new Map();
  column.forEach((key, row) => {
    if (!keep(row)) return;
    if (groups.has(key)) groups.get(key).push(row); else groups.set(key, [row]);
  });
  return groups;
}

const getChildren = later(() => {
  const children = items.id.map(() => []);
  items.parents.forEach((parents, child) => parents.forEach((parent) => { if (typeof parent === "number") children[parent].push(child); }));
  return children;
});
const getResults = later(() => groupBy(data.results.item));
const getUnexecuted = later(() => groupBy(data.unexecuted.item));
const getTags = later(() => groupBy(data.tags.item));
const getFindings = later(() => groupBy(data.findings.item));
const getCases = later(() => {
  const cases = new Map();
  data.cases.forEach(([id, anchor, status, title, shows]) => shows.forEach(([item, polarity]) => {
    if (!cases.has(item)) cases.set(item, []);
    cases.get(item).push({ id, anchor, status, title, polarity });
  }));
  return cases;
});
const getSearchTexts = later(() => items.id.map((id, i) => `${id}\n${items.title[i]}\n${items.statement[i]}`.toLowerCase()));

const rowsOf = (groups, number) => groups().get(number) || [];
const wordOf = (number) => data.verdicts[items.verdict[number]];
const resultWord = (row) => (data.results.status[row] === "error" ? "failed" : data.results.status[row]);
const placeOf = (table, row) => `${data.files[table.file[row]]}:${table.line[row]}`;
const levelNames = new Map(data.levels.map(([key, name]) => [key, name]));

// Everything above or below an item, nearest first; a cycle ends by itself.
function walk(number, next) {
  const seen = new Set([number]);
  const queue = [number];
  for (let at = 0; at < queue.length; at++) {
    for (const other of next(queue[at])) if (typeof other === "number" && !seen.has(other)) { seen.add(other); queue.push(other); }
  }
  return queue.slice(1);
}
const listAbove = (number) => walk(number, (i) => items.parents[i]);
const listBelow = (number) => walk(number, (i) => getChildren()[i]);
