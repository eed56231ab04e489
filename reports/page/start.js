// SPDX-License-Identifier: GPL-3.0-or-later
// Filters, theme, size; draws everything.

// ---- filters, theme, size ----------------------------------------------------------------------------

const drawings = [rateFigure, forestFigure, aboveFigure, aboveDeltaVFigure, ecdfFigure, deltaVFigure, differenceFigure, pairedFigure, scatterFigure, mapFigure, siteFigure, flowFigure, benefitFigure, riskFigure, corridorFigure, convergenceFigure, ...doseFigures, gallery].filter(Boolean);
function update() {
  cards();
  [exposureTable, quantileTable, contrastTable, injuryTable, precisionTable, validityTable, evidenceTable, scorecardTable].forEach(draw => draw());
  drawings.forEach(draw => draw());
}

function options(id, all, names) {
  const select = document.getElementById(id);
  element(select, "option", all, { value: "" });
  names.forEach(name => element(select, "option", readable(name), { value: name }));
  return select;
}

function theme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  const button = document.getElementById("theme");
  button.textContent = dark ? "Light" : "Dark";
  button.setAttribute("aria-pressed", String(dark));
  button.setAttribute("aria-label", dark ? "Switch to light colours" : "Switch to dark colours");
}

// A sentence a treatment, its name in bold; the text itself is in the page, for readers without a script.
function answerInLines() {
  const parent = document.getElementById("answer"), sentences = parent.textContent.trim().split("\n");
  parent.textContent = "";
  sentences.forEach(sentence => {
    const line = element(parent, "span", undefined, { class: "sentence" }), name = data.variants.map(v => v.name).filter(v => sentence.startsWith(`${v}: `)).sort((a, b) => b.length - a.length)[0];
    if (name) element(line, "strong", name);
    line.appendChild(document.createTextNode(name ? sentence.slice(name.length) : sentence));
  });
}

answerInLines();
document.getElementById("question").textContent = data.study.question || "";
options("scenario", "all", data.scenarios).onchange = event => { state.scenario = event.target.value; update(); };
options("crash-type", "all frontal", data.crash_types).onchange = event => { state.crashType = event.target.value; update(); };
document.querySelectorAll("input[name=scope]").forEach(input => { input.onchange = () => { state.scope = input.value; update(); }; });
data.variants.forEach((v, k) => {
  const label = element(document.getElementById("variants"), "label"), box = element(label, "input", undefined, { type: "checkbox", checked: "", value: v.name });
  element(label, "span", undefined, { class: "swatch" }).style.setProperty("--colour", colour(k));
  label.appendChild(document.createTextNode(v.name));
  box.onchange = () => {
    // The last one stays: a page of nothing helps nobody.
    if (!box.checked && state.variants.size === 1) { box.checked = true; return; }
    if (box.checked) state.variants.add(k); else state.variants.delete(k);
    update();
  };
});
if (!pairedFigure) document.getElementById("figure-paired").remove();
if (!forestFigure) document.getElementById("figure-forest").remove();
if (doseFigures.length === 0) document.getElementById("section-dose").remove();
if (!flowFigure) document.getElementById("section-flow").remove();
document.getElementById("filters").onsubmit = event => event.preventDefault();
const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
theme(prefersDark.matches);
prefersDark.onchange = event => theme(event.matches);
document.getElementById("theme").onclick = () => theme(document.documentElement.dataset.theme !== "dark");
let width = window.innerWidth, pending = 0;
window.addEventListener("resize", () => {
  if (window.innerWidth === width) return;
  width = window.innerWidth;
  cancelAnimationFrame(pending);
  pending = requestAnimationFrame(() => drawings.forEach(draw => draw()));
});
// Paper shows everything: tables and SQL unfolded, as far as they are filled.
window.addEventListener("beforeprint", () => theme(false));
design();
assessment();
reproduce();
activations();
update();
