// SPDX-License-Identifier: Apache-2.0
// Filter of the matrix, folds that open when they are linked to or printed. The page can be read without this script.
(() => {
  "use strict";
  const form = document.querySelector(".filter");
  const search = document.getElementById("search");
  const rows = [...document.querySelectorAll(".matrix tbody tr")];
  const folds = [...document.querySelectorAll("details")];

  const chosen = (name) => [...form.querySelectorAll(`input[name=${name}]:checked`)].map((box) => box.value);

  function filter() {
    const levels = chosen("level");
    const words = chosen("word");
    const terms = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const row of rows) {
      const data = row.dataset;
      const fits = (!levels.length || levels.includes(data.level)) && (!words.length || words.includes(data.word)) &&
        terms.every((term) => data.text.includes(term));
      row.hidden = !fits;
      count += fits;
    }
    document.getElementById("shown").textContent = `${count} of ${rows.length}`;
  }

  function openTarget() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    for (let fold = target.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    target.scrollIntoView();
  }

  form.hidden = false;
  form.addEventListener("input", filter);
  form.addEventListener("submit", (event) => event.preventDefault());
  for (const link of document.querySelectorAll("[data-levels]")) {
    link.addEventListener("click", () => {
      const levels = link.dataset.levels.split(" ");
      for (const box of form.querySelectorAll("input[name=level]")) box.checked = levels.includes(box.value);
      filter();
    });
  }
  const fold = document.getElementById("fold");
  fold.hidden = false;
  fold.addEventListener("click", (event) => {
    if (event.target.dataset.open === undefined) return;
    for (const item of document.querySelectorAll("details.item")) item.open = Boolean(event.target.dataset.open);
  });
  let closed = [];
  addEventListener("beforeprint", () => {
    // Paper shows the argument and the plots; items and suites unfold there when they are open on the screen.
    closed = folds.filter((each) => !each.open && each.matches(".scenario, #findings details"));
    for (const each of closed) each.open = true;
  });
  addEventListener("afterprint", () => { for (const each of closed) each.open = false; });
  addEventListener("hashchange", openTarget);
  filter();
  openTarget();
})();
