// SPDX-License-Identifier: Apache-2.0
// Small parts of the page. Every text of the data becomes a text node; nothing is ever parsed as HTML.
const make = (tag, attributes, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false && child !== ""));
  return element;
};
const css = (word) => word.replaceAll(" ", "-");
const badge = (word, shown = word) => make("span", { class: `badge ${css(word)}` }, shown);
const code = (text, name = "place") => make("code", { class: name }, text);
const quiet = (...children) => make("span", { class: "quiet" }, ...children);
const count = (number, noun) => `${number.toLocaleString("en")} ${noun}${number === 1 ? "" : "s"}`;
const itemAddress = (id) => `#item/${encodeURIComponent(id)}`;
const viewAddress = (view, filters) => {
  const query = new URLSearchParams(Object.entries(filters).flatMap(([name, value]) => [].concat(value).filter(Boolean).map((each) => [name, each])));
  return query.size ? `#${view}?${query}` : `#${view}`;
};

// Long names may break where a word in them begins.
const breakable = (name) => name.split(/(?<=[a-z0-9])(?=[A-Z])|(?<=[._:/\[])/).flatMap((part, at) => (at ? [make("wbr"), part] : [part]));

// A link to an item named by its number, or the bare id where the project has no such item.
function itemLink(item, ...more) {
  if (typeof item !== "number") return make("span", { class: "unknown", title: "no such item" }, item);
  return make("a", { class: "id", href: itemAddress(items.id[item]), title: items.title[item] }, items.id[item], ...more);
}

// A list that grows on demand: `draw` makes the element of one row.
function growing(list, rows, step, draw, noun) {
  const holder = make("div");
  const body = list.querySelector("tbody") || list;
  const button = make("button", { type: "button" });
  const left = make("span", { class: "quiet" });
  const bar = make("div", { class: "more" }, button, left);
  let drawn = 0;
  const grow = (wanted) => {
    const end = Math.min(rows.length, drawn + wanted);
    const fresh = document.createDocumentFragment();
    const first = drawn;
    for (; drawn < end; drawn++) fresh.append(draw(rows[drawn], drawn));
    body.append(fresh);
    bar.hidden = drawn >= rows.length;
    button.textContent = `Show ${Math.min(step, rows.length - drawn)} more`;
    left.textContent = `${drawn.toLocaleString("en")} of ${count(rows.length, noun)}`;
    return first;
  };
  button.addEventListener("click", () => {
    const first = grow(step);
    const link = body.children[first] && body.children[first].querySelector("a, button");
    if (link) link.focus({ preventScroll: true });
  });
  grow(step);
  holder.append(list, bar);
  holder.growAll = (most) => grow(Math.max(0, most - drawn));
  return holder;
}

const heads = (names) => make("thead", {}, make("tr", {}, names.map((name) => make("th", { scope: "col" }, name))));
