// SPDX-License-Identifier: Apache-2.0
// Search over ids, titles and statements, by keyboard or pointer.
const HITS_MAX = 50;
const searchField = document.getElementById("search");
const hitList = document.getElementById("hits");
const answer = document.getElementById("answer");
let active = -1;

// Best first: the id itself, ids that begin so, ids that hold it, titles, statements. @return the best ones and the number of all.
function searchItems(text) {
  const terms = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (!terms.length) return { best: [], total: 0 };
  const texts = getSearchTexts();
  const ranks = [[], [], [], [], []];
  let total = 0;
  for (let i = 0; i < itemCount; i++) {
    const whole = texts[i];
    if (!terms.every((term) => whole.includes(term))) continue;
    total++;
    const idEnd = whole.indexOf("\n");
    const at = whole.indexOf(terms[0]);
    const titleEnd = whole.indexOf("\n", idEnd + 1);
    const rank = at === 0 && idEnd === terms[0].length ? 0 : at === 0 ? 1 : at < idEnd ? 2 : at < titleEnd ? 3 : 4;
    if (ranks[rank].length < HITS_MAX) ranks[rank].push(i);
  }
  return { best: ranks.flat().slice(0, HITS_MAX), total };
}

// `text` with the searched words marked.
function markWords(text, terms) {
  const lower = text.toLowerCase();
  if (lower.length !== text.length) return [text]; // letters that change their length would shift the marks
  const parts = [];
  let at = 0;
  while (at < text.length) {
    let best = -1;
    let length = 0;
    for (const term of terms) { const found = lower.indexOf(term, at); if (found >= 0 && (best < 0 || found < best)) { best = found; length = term.length; } }
    if (best < 0) break;
    parts.push(text.slice(at, best), make("mark", {}, text.slice(best, best + length)));
    at = best + length;
  }
  parts.push(text.slice(at));
  return parts;
}

function cutAround(text, terms) {
  const lower = text.toLowerCase();
  const first = Math.min(...terms.map((term) => lower.indexOf(term)).filter((at) => at >= 0), text.length);
  return first > 70 && first < text.length ? `…${text.slice(first - 40)}` : text;
}

function drawHit(i, at, terms) {
  return make("li", { role: "option", id: `hit-${at}`, "aria-selected": "false", onclick: () => openHit(at), "data-item": i },
    make("span", { class: "id" }, markWords(items.id[i], terms)), make("span", { class: "title" }, markWords(items.title[i], terms)), badge(wordOf(i)),
    make("span", { class: "text" }, markWords(cutAround(items.statement[i], terms), terms)));
}

function answerSearch() {
  const text = searchField.value.trim();
  const { best, total } = searchItems(text);
  const terms = text.toLowerCase().split(/\s+/).filter(Boolean);
  hitList.replaceChildren(...best.map((i, at) => drawHit(i, at, terms)));
  document.getElementById("hit-count").textContent = total > best.length ? `The best ${best.length} of ${count(total, "item")}` : count(total, "item");
  answer.hidden = !text;
  searchField.setAttribute("aria-expanded", String(Boolean(text)));
  choose(best.length ? 0 : -1);
}

function choose(next) {
  if (hitList.children[active]) hitList.children[active].setAttribute("aria-selected", "false");
  active = next;
  const hit = hitList.children[active];
  if (hit) { hit.setAttribute("aria-selected", "true"); hit.scrollIntoView({ block: "nearest" }); }
  if (hit) searchField.setAttribute("aria-activedescendant", hit.id); else searchField.removeAttribute("aria-activedescendant");
}

function closeSearch() {
  answer.hidden = true;
  searchField.setAttribute("aria-expanded", "false");
  searchField.removeAttribute("aria-activedescendant");
}

function openHit(at) {
  const hit = hitList.children[at];
  if (!hit) return;
  closeSearch();
  searchField.value = "";
  searchField.blur();
  location.hash = itemAddress(items.id[Number(hit.dataset.item)]);
}

function handleSearchKey(event) {
  const last = hitList.children.length - 1;
  if (event.key === "Escape") { closeSearch(); searchField.value = ""; searchField.blur(); }
  else if (event.key === "Enter") openHit(active);
  else if (event.key === "ArrowDown") choose(active < last ? active + 1 : 0);
  else if (event.key === "ArrowUp") choose(active > 0 ? active - 1 : last);
  else return;
  event.preventDefault();
}

searchField.addEventListener("input", answerSearch);
// The texts are put together before the first letter, so that it is answered like the others.
(globalThis.requestIdleCallback || setTimeout)(() => getSearchTexts());
searchField.addEventListener("focus", () => { getSearchTexts(); if (searchField.value.trim()) answerSearch(); });
searchField.addEventListener("keydown", handleSearchKey);
document.addEventListener("pointerdown", (event) => { if (!event.target.closest(".find")) closeSearch(); });
document.querySelector(".find").hidden = false;
