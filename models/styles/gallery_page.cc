// HTML, CSS and JavaScript of a gallery, as they reach the browser.
#include "models/styles/gallery_page.h"

namespace gestus::styles {

const char* const kGalleryHead = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="gestus">
<title>Styles</title>
<link rel="icon" href="data:,">
<style>
:root { color-scheme: light; --back: #f7f7f5; --card: #fff; --ink: #1d2125; --soft: #667079;
  --line: #dcdfe2; --accent: #2458c5; --dot: 45%; --heat: 36, 88, 197; }
:root[data-theme="dark"] { color-scheme: dark; --back: #15181b; --card: #1e2226; --ink: #e8eaec;
  --soft: #98a2ab; --line: #343a40; --accent: #8fb2ff; --dot: 66%; --heat: 143, 178, 255; }
* { box-sizing: border-box; }
body { margin: 0; padding: 1.25rem; background: var(--back); color: var(--ink);
  font: 15px/1.45 system-ui, sans-serif; }
main { max-width: 76rem; margin: auto; }
header { display: flex; flex-wrap: wrap; gap: .5rem 1rem; align-items: baseline; }
h1 { font-size: 1.5rem; margin: 0; }
h2 { font-size: 1rem; margin: 0; }
p, small { color: var(--soft); margin: .2rem 0; }
button { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line);
  border-radius: .4rem; padding: .25rem .7rem; cursor: pointer; }
button[aria-pressed="true"] { border-color: var(--accent); color: var(--accent); }
.intro { margin: 0; color: var(--soft); max-width: 60rem; }
.bar { display: flex; flex-wrap: wrap; gap: .4rem; margin: .8rem 0; align-items: center; }
.maps { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(21rem, 100%), 1fr));
  gap: .8rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .6rem;
  padding: .8rem; overflow: auto; }
.card + .card.wide, .maps + .card { margin-top: .8rem; }
svg { width: 100%; height: auto; display: block; }
svg text { font-size: 12px; fill: var(--ink); pointer-events: none; }
svg .axis { stroke: var(--line); }
svg circle { cursor: pointer; stroke: var(--card); stroke-width: 1.5; }
svg circle:focus { outline: none; stroke: var(--ink); }
.chosen svg g:not(.on) { opacity: .25; }
svg g.on circle { stroke: var(--ink); stroke-width: 2; }
svg g.on text { font-weight: 600; display: inline; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th { font-weight: 500; text-align: right; padding: .2rem .5rem; max-width: 14rem; overflow: hidden;
  text-overflow: ellipsis; white-space: nowrap; }
td { text-align: center; padding: .2rem .35rem; min-width: 2.6rem; }
th.on { color: var(--accent); }
</style>
</head>
<body>
<main>
<header><h1>Styles</h1><p id="about"></p><button id="theme" style="margin-left:auto">dark</button></header>
<p class="intro">A point is a style: what the network keeps of how a speaker moves, to move another like that. Styles
near each other are alike. Each map shows one part of them; the table below has the numbers.</p>
<div class="bar" id="kinds"></div>
<div class="maps" id="maps"></div>
<div class="card" id="details" aria-live="polite"></div>
<div class="card wide"><div class="bar" id="parts"></div><div id="distances"></div></div>
<noscript>This page draws its maps by JavaScript.</noscript>
</main>
<script type="application/json" id="data">)html";

const char* const kGalleryTail = R"html(</script>
<script>
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const count = data.names.length;
const title = (name) => name[0].toUpperCase() + name.slice(1);
const colour = (i) => `hsl(${(i * 137.5 + 215) % 360} 62% var(--dot))`;
const number = (x) => x === null ? "–" : Math.abs(x) < 1e4 ? x.toFixed(3) : x.toPrecision(4);
const mostInTable = 60;
let kind = "components", part = 0, chosen = -1;

function element(name, attributes = {}, text = "") {
  const svg = ["svg", "g", "circle", "text", "line", "title"].includes(name);
  const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", name)
                   : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== "") made.textContent = text;
  return made;
}

// Points with equal scales of both axes, as large as the frame allows.
function place(points, width, height, edge) {
  const range = (axis) => {
    const all = points.map((p) => p[axis]);
    return [Math.min(...all), Math.max(...all)];
  };
  const [x0, x1] = range(0), [y0, y1] = range(1);
  const scale = Math.min((width - 2 * edge) / (x1 - x0 || 1e-300),
                         (height - 2 * edge) / (y1 - y0 || 1e-300));
  const used = x1 === x0 && y1 === y0 ? 0 : scale;
  return points.map(([x, y]) => [width / 2 + (x - (x0 + x1) / 2) * used,
                                 height / 2 - (y - (y0 + y1) / 2) * used]);
}

// The first of eight places around each point where its name meets no other name and no point.
function labels(at, width, height) {
  const taken = at.map(([x, y]) => [x - 6, y - 6, x + 6, y + 6]);
  const free = (box) => box[0] >= 0 && box[1] >= 0 && box[2] <= width && box[3] <= height &&
    !taken.some((t) => box[0] < t[2] && t[0] < box[2] && box[1] < t[3] && t[1] < box[3]);
  return at.map(([x, y], i) => {
    const text = shortName(i), w = 6.6 * text.length, h = 13;
    const spots = [[8, -h / 2, "start"], [-8, -h / 2, "end"], [0, -8 - h, "middle"], [0, 8, "middle"],
                   [6, -6 - h, "start"], [6, 6, "start"], [-6, -6 - h, "end"], [-6, 6, "end"]];
    const behind = {start: 0, middle: w / 2, end: w};
    for (const [dx, dy, anchor] of spots) {
      const left = x + dx - behind[anchor], top = y + dy, box = [left, top, left + w, top + h];
      if (!free(box)) continue;
      taken.push(box);
      return {text, x: x + dx, y: top + 10, anchor, shown: true};
    }
    const anchor = x < width / 2 ? "start" : "end";
    return {text, x, y: Math.max(y - 8, 10), anchor, shown: false};
  });
}

function shortName(i) {
  const letters = [...data.names[i]];
  return letters.length > 24 ? letters.slice(0, 23).join("") + "…" : data.names[i];
}

function map(p) {
  const width = 400, height = 300, card = element("section", {class: "card"});
  card.append(element("h2", {}, p.name === "style" ? "Whole style" : title(p.name)));
  const points = kind === "neighbours" ? p.neighbours : p.components;
  card.append(element("small", {}, `${p.width} values. ` + (kind === "neighbours"
    ? `t-SNE, perplexity ${number(p.perplexity)}, divergence ${number(p.divergence)}`
    : `Axes hold ${(100 * p.explained[0]).toFixed(0)} % and ${(100 * p.explained[1]).toFixed(0)} % ` +
      "of the variance")));
  const svg = element("svg", {viewBox: `0 0 ${width} ${height}`, role: "group",
                              "aria-label": "Map of " + p.name});
  svg.append(element("line", {class: "axis", x1: 0, x2: width, y1: height / 2, y2: height / 2}),
             element("line", {class: "axis", x1: width / 2, x2: width / 2, y1: 0, y2: height}));
  const at = place(points, width, height, 28), names = labels(at, width, height);
  at.forEach(([x, y], i) => {
    const group = element("g", {"data-style": i});
    const dot = element("circle", {cx: x, cy: y, r: 5.5, fill: colour(i), tabindex: 0,
                                   role: "button", "aria-label": data.names[i]});
    dot.append(element("title", {}, data.names[i]));
    const {text, x: left, y: base, anchor} = names[i];
    const name = element("text", {x: left, y: base, "text-anchor": anchor}, text);
    if (!names[i].shown) name.style.display = "none";
    for (const event of ["mouseenter", "focus", "click"])
      dot.addEventListener(event, () => choose(i));
    dot.addEventListener("keydown", (e) => { if (e.key === "Escape") choose(-1); });
    group.append(dot, name);
    svg.append(group);
  });
  svg.addEventListener("click", (e) => { if (e.target === svg) choose(-1); });
  card.append(svg);
  return card;
}

function choose(i) {
  chosen = i;
  byId("maps").classList.toggle("chosen", i >= 0);
  document.querySelectorAll("svg g").forEach((g) => {
    const on = Number(g.dataset.style) === i;
    g.classList.toggle("on", on);
    if (g.querySelector("text").style.display !== "none" || !on) return;
    g.querySelector("text").style.display = "";
    g.querySelector("text").dataset.hidden = "1";
  });
  document.querySelectorAll("svg g:not(.on) text[data-hidden]").forEach((text) => {
    text.style.display = "none";
    delete text.dataset.hidden;
  });
  document.querySelectorAll("th[data-style]").forEach(
    (th) => th.classList.toggle("on", Number(th.dataset.style) === i));
  details();
}

function details() {
  const box = byId("details");
  box.replaceChildren();
  if (chosen < 0) {
    box.append(element("p", {}, "Point at a style to find it on every map."));
    return;
  }
  box.append(element("h2", {}, data.names[chosen]));
  const sources = data.made_of[chosen].map((s) =>
    `${(100 * s.share).toFixed(0)} % ${s.name}` + (s.segments ? ` (${s.segments} segments)` : ""));
  box.append(element("p", {}, sources.length ? "Made of " + sources.join(", ")
                                             : "What it was made of is not known."));
  for (const p of data.parts) {
    const nearest = [...Array(count).keys()].filter((i) => i !== chosen && p.cosine[chosen][i] !== null)
      .sort((a, b) => p.cosine[chosen][a] - p.cosine[chosen][b]).slice(0, 3)
      .map((i) => `${data.names[i]} ${number(p.cosine[chosen][i])}`);
    box.append(element("p", {}, `${title(p.name)}: ` + (nearest.length
      ? "nearest by cosine distance " + nearest.join(", ") : "nothing in it")));
  }
}

function distances() {
  if (count > mostInTable) {
    byId("distances").replaceChildren(element("p", {}, "Too many styles for a table: " +
      "infer-cli style distance writes one."));
    return;
  }
  const p = data.parts[part], table = element("table"), head = element("tr");
  const largest = Math.max(...p.cosine.flat().map((x) => x ?? 0)) || 1;
  head.append(element("th"));
  const header = (i) => element("th", {"data-style": i, title: data.names[i]}, shortName(i));
  for (let i = 0; i < count; ++i) head.append(header(i));
  table.append(head);
  p.cosine.forEach((row, i) => {
    const line = element("tr");
    line.append(header(i));
    row.forEach((x, j) => {
      const cell = element("td", {title: `${data.names[i]} – ${data.names[j]}: cosine distance ` +
        `${number(x)}, Euclidean ${number(p.euclidean[i][j])}`}, number(x));
      cell.style.background = `rgba(var(--heat), ${(0.65 * (x ?? 0) / largest).toFixed(3)})`;
      line.append(cell);
    });
    table.append(line);
  });
  byId("distances").replaceChildren(element("p", {}, "Cosine distance: 0 the same direction, 1 " +
    "nothing in common, 2 the opposite."), table);
}

function buttons(place, entries, now, act) {
  byId(place).replaceChildren(...entries.map(([key, text]) => {
    const button = element("button", {"aria-pressed": key === now}, text);
    button.addEventListener("click", () => act(key));
    return button;
  }));
}

function draw() {
  const both = data.parts[0].neighbours !== null;
  buttons("kinds", both ? [["components", "Principal components"], ["neighbours", "Neighbours (t-SNE)"]]
                        : [["components", "Principal components"]], kind, (key) => {
    kind = key;
    draw();
  });
  buttons("parts", data.parts.map((p, i) => [i, p.name === "style" ? "Whole style" : title(p.name)]),
          part, (key) => { part = key; draw(); });
  byId("maps").replaceChildren(...data.parts.map(map));
  distances();
  choose(chosen);
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  byId("theme").textContent = name === "dark" ? "light" : "dark";
}

byId("about").textContent = `${count} styles of ${data.weights || "weights"} ${data.checksum}` +
  (data.trained === false ? ". UNTRAINED weights: distances mean nothing" : "");
byId("theme").addEventListener("click",
  () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
theme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
draw();
</script>
</body>
</html>
)html";

}  // namespace gestus::styles
