// SPDX-License-Identifier: GPL-3.0-or-later
// What every part of the page uses: data and state, words and numbers, filters, tables, the frame of a figure.

const data = JSON.parse(document.getElementById("data").textContent);
const vehicles = data.vehicles;
const state = { scenario: "", crashType: "", scope: "all", variants: new Set(data.variants.map((v, k) => k)) };
const CENSORED = 1, FAILED = 2;
const SYMBOLS = [d3.symbolCircle, d3.symbolTriangle, d3.symbolSquare, d3.symbolDiamond, d3.symbolCross, d3.symbolStar];
const DASHES = [null, "7 3", "2 3", "9 3 2 3", "5 5", "1 4"];

// ---- words and numbers --------------------------------------------------------------------

const colour = variant => `var(--v${variant % 6})`;
const missing = value => value === null || value === undefined;
const fixed = (value, digits) => missing(value) ? "–" : value.toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "−");
// A ratio; what is beyond a thousand is no more than that.
const ratio = value => missing(value) ? "–" : value > 1000 ? "> 1000" : fixed(value, 2);
const integer = value => missing(value) ? "–" : d3.format(",")(value).replace(/,/g, " ");
const crashes = (n, kind) => `${integer(n)} ${kind ? `${kind} ` : ""}crash${n === 1 ? "" : "es"}`;
const percent = value => missing(value) ? "–" : `${(100 * value).toFixed(0)} %`;
const estimate = (e, digits) => missing(e) ? "–" : (e.relation === "=" ? "" : `${e.relation} `) + fixed(e.value, digits);
const pValue = p => missing(p) ? "–" : p < 0.001 ? "< 0.001" : p.toFixed(3);
// Three significant digits, thousands apart.
const rate = value => missing(value) ? "–" : value >= 1000 ? integer(Number(value.toPrecision(3))) : String(Number(value.toPrecision(3)));
// Names of the study as words; a swept one names its parameter as the study file does.
const readable = text => (text.includes("@") ? text : text.replace(/_/g, " ")).replace(/,/g, ", ");

function interval(i, format) {
  if (!i || i.status !== "value") return i ? i.status : "–";
  return `${missing(i.low) ? "−∞" : format(i.low)} to ${missing(i.high) ? "∞" : format(i.high)}`;
}

// ---- what the filters select ----------------------------------------------------------------

function slice() {
  return data.slices.find(s => (s.scenario || "") === state.scenario && (s.crash_type || "") === state.crashType);
}

// Index of a variant by its name; figures of a slice, chosen variants only.
const indexOf = name => data.variants.findIndex(v => v.name === name);
const shownVariants = () => slice().variants.filter(v => state.variants.has(indexOf(v.variant)));
const shownContrasts = () => slice().contrasts.filter(c => state.variants.has(indexOf(c.variant)));
const shownPairs = () => slice().counterfactual.filter(c => state.variants.has(indexOf(c.variant)));

// Indices of the frontally struck vehicles in the present slice, scope and variants.
function chosen() {
  const scenario = data.scenarios.indexOf(state.scenario), type = data.crash_types.indexOf(state.crashType);
  return d3.range(vehicles.variant.length).filter(k =>
    state.variants.has(vehicles.variant[k]) &&
    (state.scenario === "" || vehicles.scenario[k] === scenario) &&
    (state.crashType === "" || vehicles.crash_type[k] === type) &&
    (state.scope === "all" || vehicles.validity[k] === 0));
}

function scopeText() {
  return state.scope === "all" ? "all frontally struck vehicles" : "vehicles inside the validated range";
}

// In the counterfactual design single crashes of a treatment are those of the baseline that still happen.
const treatedText = () => (slice().judged ? " With a treatment: what the baseline’s crashes became, as far as they were not avoided." : "");

// ---- building blocks --------------------------------------------------------------------------

function element(parent, tag, text, attributes) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const name in attributes || {}) node.setAttribute(name, attributes[name]);
  parent.appendChild(node);
  return node;
}

function download(name, type, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type: type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function csv(columns, rows) {
  const cell = value => missing(value) ? "" : /[",\n]/.test(value) ? `"${String(value).replace(/"/g, '""')}"` : String(value);
  return [columns, ...rows].map(row => row.map(cell).join(",")).join("\n") + "\n";
}

// A copy with every style written out, so that the file looks the same without this page.
function standaloneSvg(svg) {
  const copy = svg.cloneNode(true);
  const originals = [svg, ...svg.querySelectorAll("*")], copies = [copy, ...copy.querySelectorAll("*")];
  originals.forEach((node, k) => {
    const style = getComputedStyle(node);
    for (const property of ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "fill-opacity", "font-family", "font-size", "font-weight", "text-anchor"])
      copies[k].style.setProperty(property, style.getPropertyValue(property));
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.style.background = getComputedStyle(document.documentElement).getPropertyValue("--surface").trim();
  return new XMLSerializer().serializeToString(copy);
}

const fileName = (name, ending) =>
  [data.study.name, name, state.scenario, state.crashType].filter(Boolean).join("-").replace(/[^\w.-]+/g, "_") + "." + ending;

// A table; columns are {name, text} with text for left-aligned ones.
function table(parent, caption, columns, rows) {
  const node = element(parent, "table");
  if (caption) element(node, "caption", caption);
  const head = element(element(node, "thead"), "tr");
  columns.forEach(c => element(head, "th", c.name, c.text ? { scope: "col", class: "text" } : { scope: "col" }));
  const body = element(node, "tbody");
  rows.forEach(row => {
    const line = element(body, "tr");
    row.forEach((value, k) => {
      const cell = element(line, k === 0 ? "th" : "td", value, columns[k].text ? { class: "text" } : {});
      if (k === 0) cell.setAttribute("scope", "row");
    });
  });
  return node;
}

function sqlDetails(parent, name) {
  const query = data.queries.find(q => q.name === name);
  if (!query) return;
  const details = element(parent, "details");
  element(details, "summary", `SQL: ${name}.sql`);
  element(details, "pre", query.sql);
}

// Everything around a drawing: caption, drawing area, downloads, table, SQL. content() gives
// {summary, columns, rows}; draw(svg, width) draws and returns the height.
function figure(id, title, note, draw, content) {
  const node = document.getElementById(id);
  const caption = element(node, "figcaption");
  element(caption, "h2", title);
  const text = element(caption, "p");
  const area = element(node, "div", undefined, { class: "area" });
  const tools = element(node, "div", undefined, { class: "tools" });
  const asCsv = element(tools, "button", "CSV", { type: "button", "aria-label": `Data of “${title}” as CSV` });
  const asSvg = element(tools, "button", "SVG", { type: "button", "aria-label": `“${title}” as SVG` });
  asCsv.onclick = () => { const c = content(); download(fileName(id.replace("figure-", ""), "csv"), "text/csv", csv(c.columns, c.rows)); };
  asSvg.onclick = () => { const svg = area.querySelector("svg"); if (svg) download(fileName(id.replace("figure-", ""), "svg"), "image/svg+xml", standaloneSvg(svg)); };
  const details = element(tools, "details");
  element(details, "summary", "Show as table");
  const holder = element(details, "div", undefined, { class: "scroll limits-height", tabindex: "0", role: "region", "aria-label": `Table of “${title}”` });
  const fill = () => {
    holder.textContent = "";
    const c = content(), shown = c.rows.slice(0, 200);
    table(holder, shown.length < c.rows.length ? `First 200 of ${c.rows.length} rows; all of them in the CSV file.` : "",
      c.columns.map(name => ({ name: name })), shown.map(row => row.map(v => missing(v) ? "–" : typeof v === "number" ? String(Number(v.toPrecision(5))) : v)));
  };
  details.ontoggle = () => { if (details.open) fill(); };
  sqlDetails(tools, node.dataset.query);

  function redraw() {
    text.textContent = note();
    area.textContent = "";
    const width = Math.max(280, area.clientWidth), c = content();
    if (c.rows.length === 0) {
      element(area, "p", "No crash in this selection.", { class: "empty" });
    } else {
      const svg = d3.select(area).append("svg").attr("role", "img").attr("aria-label", `${title}. ${c.summary}`);
      const height = draw(svg, width);
      svg.attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height);
    }
    if (details.open) fill();
  }
  return redraw;
}

// Axes with a light grid; returns the inner group.
function frame(svg, width, height, margin, x, y, xTitle, yTitle, yPlaces) {
  const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
  const w = width - margin.left - margin.right, h = height - margin.top - margin.bottom;
  const xTicks = Math.max(3, Math.round(w / 75)), yTicks = Math.max(3, Math.round(h / 50));
  const places = yPlaces || y.ticks(yTicks);
  inner.selectAll(null).data(places).enter().append("line").attr("class", "gridline")
    .attr("x2", w).attr("y1", y).attr("y2", y);
  inner.selectAll(null).data(x.ticks(xTicks)).enter().append("line").attr("class", "gridline")
    .attr("y2", h).attr("x1", x).attr("x2", x);
  inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(xTicks).tickFormat(x.wholeNumbers ? v => (Number.isInteger(v) ? integer(v) : "") : null).tickSizeOuter(0));
  inner.append("g").attr("class", "axis").call(d3.axisLeft(y).tickValues(places).tickSizeOuter(0));
  inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text(xTitle);
  inner.append("text").attr("class", "axis-title").attr("transform", `translate(${-margin.left + 14},${h / 2}) rotate(-90)`)
    .attr("text-anchor", "middle").text(yTitle);
  return inner;
}

// One line of entries {variant, label}, wrapped at the width; returns the height used.
function legend(svg, width, entries, mark) {
  let x = 4, y = 14;
  entries.forEach(entry => {
    const length = 30 + 6.7 * entry.label.length;
    if (x > 4 && x + length > width) { x = 4; y += 20; }
    const g = svg.append("g").attr("transform", `translate(${x},${y})`);
    mark(g, entry.variant);
    g.append("text").attr("x", 24).attr("y", 4).text(entry.label);
    x += length + 10;
  });
  return y + 14;
}

const symbol = (variant, size) => d3.symbol().type(SYMBOLS[variant % 6]).size(size)();
const pointMark = (g, v) => g.append("path").attr("transform", "translate(9,0)").attr("d", symbol(v, 60)).style("fill", colour(v));
const lineMark = (g, v) => g.append("line").attr("x2", 18).style("stroke", colour(v)).style("stroke-width", 2.5).style("stroke-dasharray", DASHES[v % 6]);

// A vertical line that follows the pointer over a plot, with a word for each curve. text(x) gives lines.
function readout(svg, inner, x, height, text) {
  const line = inner.append("line").attr("y2", height).style("stroke", "var(--soft)").style("display", "none");
  const box = inner.append("text").attr("y", 12).style("display", "none").attr("class", "readout");
  inner.append("rect").attr("width", x.range()[1]).attr("height", height).style("fill", "transparent")
    .on("mousemove touchmove", function () {
      const at = Math.max(0, Math.min(x.range()[1], d3.mouse(this)[0])), left = at > x.range()[1] / 2;
      line.style("display", null).attr("x1", at).attr("x2", at);
      box.style("display", null).attr("text-anchor", left ? "end" : "start").selectAll("tspan").remove();
      text(x.invert(at)).forEach((words, k) => box.append("tspan").attr("x", at + (left ? -7 : 7)).attr("dy", k ? 15 : 0).text(words));
    })
    .on("mouseleave touchend", () => { line.style("display", "none"); box.style("display", "none"); });
}
