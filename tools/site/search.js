// SPDX-License-Identifier: Apache-2.0
// Search in the pages' texts: all words must occur; pages whose title has them come first.
const box = document.getElementById("search");
const results = document.getElementById("results");
const list = document.getElementById("pages");

function excerpt(text, word) {
  const at = text.toLowerCase().indexOf(word);
  return at < 0 ? "" : "… " + text.slice(Math.max(0, at - 40), at + 80) + " …";
}

function found(words) {
  const has = (text, word) => text.toLowerCase().includes(word);
  return pages
    .filter((page) => words.every((word) => has(page.title + " " + page.text, word)))
    .map((page) => ({ page, rank: words.filter((word) => has(page.title, word)).length }))
    .sort((a, b) => b.rank - a.rank)
    .slice(0, 12);
}

box.addEventListener("input", () => {
  const words = box.value.toLowerCase().split(/\s+/).filter(Boolean);
  results.hidden = words.length === 0;
  list.hidden = words.length > 0;
  results.replaceChildren(
    ...(words.length ? found(words) : []).map(({ page }) => {
      const item = document.createElement("li");
      const link = document.createElement("a");
      link.href = document.body.dataset.root + "/" + page.url;
      link.textContent = page.title;
      const text = document.createElement("p");
      text.textContent = excerpt(page.text, words[0]);
      item.append(link, text);
      return item;
    }),
  );
});
