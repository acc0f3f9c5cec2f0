// SPDX-License-Identifier: Apache-2.0
// Which view is shown: the fragment of the address says so. Also the colours, the keys and the paper.
let lastMatrix = "";
const drawnViews = { matrix, findings, tests, code: codeView };
const sections = [...document.querySelectorAll("main > section.view")];

function showSection(section) {
  for (const each of sections) each.classList.toggle("shown", each === section);
  const name = section.id === "items" ? "matrix" : section.id;
  for (const link of document.querySelectorAll("nav a")) {
    if (link.getAttribute("href") === `#${name}`) { link.setAttribute("aria-current", "page"); link.scrollIntoView({ block: "nearest", inline: "nearest" }); }
    else link.removeAttribute("aria-current");
  }
}

function decode(text) {
  try { return decodeURIComponent(text); } catch (error) { return text; }
}

// The rows of the matrix as they were last filtered lead from item to item.
function findNeighbours(number) {
  const rows = matrix.fitting && matrix.fitting.includes(number) ? matrix.fitting : allItems();
  const at = rows.indexOf(number);
  return [rows[at - 1], rows[at + 1]];
}

function showItem(number) {
  const section = document.getElementById("items");
  const holder = section.querySelector(".drawn");
  holder.replaceChildren(...drawItem(number, findNeighbours(number)));
  holder.hidden = false;
  document.title = `${items.id[number]} ${items.title[number]} – Mamori evidence report`;
  showSection(section);
  arrive(section);
}

// To the top of the view; the focus follows, so that the next Tab goes on from there.
function arrive(target) {
  if (hasArrived) target.focus({ preventScroll: true });
  if (sections.includes(target)) scrollTo(0, 0); else target.scrollIntoView();
}
let hasArrived = false;

function route() {
  const [name, query = ""] = location.hash.slice(1).split(/\?(.*)/s);
  const id = decode(name);
  const number = numberOf.get(id.startsWith("item/") ? id.slice(5) : id);
  const target = number !== undefined && !sections.some((section) => section.id === id) ? null : document.getElementById(id);
  if (number !== undefined && !target) { showItem(number); hasArrived = true; return; }
  const section = (target && target.closest("section.view")) || sections[0];
  document.title = `${section.querySelector("h1").textContent} – Mamori evidence report`;
  if (section.id === "matrix") lastMatrix = query ? `?${query}` : "";
  if (section.id === "items") { location.replace(`#matrix${lastMatrix}`); return; }
  if (drawnViews[section.id]) drawnViews[section.id].show(new URLSearchParams(query));
  for (let fold = target && target.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
  showSection(section);
  arrive(target && target.id !== "content" ? target : section);
  hasArrived = true;
}

const THEMES = [["", "◐", "Auto"], ["light", "○", "Light"], ["dark", "●", "Dark"]];
const themeButton = document.getElementById("theme");

function showTheme() {
  const [, sign, label] = THEMES.find(([name]) => name === (document.documentElement.dataset.theme || "")) || THEMES[0];
  themeButton.replaceChildren(sign, make("span", {}, ` ${label}`));
  themeButton.setAttribute("aria-label", `Colours: ${label.toLowerCase()}; change`);
}

function changeTheme() {
  const at = THEMES.findIndex(([name]) => name === (document.documentElement.dataset.theme || ""));
  const [name] = THEMES[(at + 1) % THEMES.length];
  document.documentElement.dataset.theme = name;
  try { localStorage.setItem("mamori-theme", name); } catch (error) { /* kept for as long as the page is open */ }
  showTheme();
}

function handleKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, textarea")) return;
  if (event.key === "/") { searchField.focus(); searchField.select(); event.preventDefault(); }
  const step = document.querySelector(`#items.shown a[aria-keyshortcuts="${CSS.escape(event.key)}"]`);
  if (step) { location.hash = step.getAttribute("href"); event.preventDefault(); }
}

const PRINT_ROWS_MAX = 3000;
let closed = [];
function unfoldForPaper() {
  for (const list of document.querySelectorAll(".shown .drawn div")) if (list.growAll) list.growAll(PRINT_ROWS_MAX);
  closed = [...document.querySelectorAll(".shown details")].filter((each) => !each.open);
  for (const each of closed) each.open = true;
}

for (const link of document.querySelectorAll("[data-query]")) link.setAttribute("href", `${link.getAttribute("href")}?${link.dataset.query}`);
document.querySelector(".skip").addEventListener("click", (event) => { event.preventDefault(); document.getElementById("content").focus(); });
themeButton.addEventListener("click", changeTheme);
themeButton.hidden = false;
showTheme();
addEventListener("keydown", handleKey);
addEventListener("beforeprint", unfoldForPaper);
addEventListener("afterprint", () => { for (const each of closed) each.open = false; });
addEventListener("hashchange", route);
route();
