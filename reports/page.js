// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
(function () {
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
  const integer = value => missing(value) ? "–" : d3.format(",")(value).replace(/,/g, " ");
  const crashes = (n, kind) => `${integer(n)} ${kind ? `${kind} ` : ""}crash${n === 1 ? "" : "es"}`;
  const percent = value => missing(value) ? "–" : `${(100 * value).toFixed(0)} %`;
  const estimate = (e, digits) => missing(e) ? "–" : (e.relation === "=" ? "" : `${e.relation} `) + fixed(e.value, digits);
  const pValue = p => missing(p) ? "–" : p < 0.001 ? "< 0.001" : p.toFixed(3);
  // Three significant digits, thousands apart.
  const rate = value => missing(value) ? "–" : value >= 1000 ? integer(Number(value.toPrecision(3))) : String(Number(value.toPrecision(3)));
  const readable = text => text.replace(/_/g, " ").replace(/,/g, ", ");

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
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(xTicks).tickSizeOuter(0));
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

  // ---- crash rates ----------------------------------------------------------------------------------

  const rateFigure = figure("figure-rate", "Frontal crash rate",
    () => "Frontal crashes per million vehicle-km, of any validity. Thick: 95 % bootstrap over replications, from 20 replications on. Thin: 95 % interval of Poisson counts, widened by what replications scatter more (dispersion above 1), from any number of them; with one replication a scenario that is not known and not in it.",
    function (svg, width) {
      const rows = shownVariants(), margin = { top: 8, right: 16, bottom: 48, left: 16 };
      const band = Math.max(58, Math.min(104, 300 / rows.length)), height = margin.top + band * rows.length + margin.bottom, w = width - margin.left - margin.right;
      const upper = d3.max(rows, v => d3.max([v.frontal_crashes_per_million_km.value, v.frontal_crashes_per_million_km.widened.high, v.frontal_crashes_per_million_km.bootstrap.high]));
      const x = d3.scaleLinear().domain([0, upper || 1]).nice().range([0, w]);
      const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`), h = band * rows.length;
      const ticks = Math.max(3, Math.round(w / 90));
      inner.selectAll(null).data(x.ticks(ticks)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
      inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(ticks).tickFormat(integer).tickSizeOuter(0));
      inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("frontal crashes per 10⁶ vehicle-km");
      rows.forEach((v, row) => {
        const k = indexOf(v.variant), r = v.frontal_crashes_per_million_km, y = band * (row + 0.5) + 10;
        const label = inner.append("text").attr("y", y - 16);
        label.append("tspan").style("font-weight", 600).text(v.variant);
        label.append("tspan").attr("class", "soft").text(`  ${crashes(v.frontal_crashes)} in ${integer(Math.round(v.vehicle_km))} veh-km${width < 460 ? "" : `, dispersion ${fixed(r.widening.dispersion, 2)}`}`);
        if (missing(r.value)) return;
        const bar = (i, thick) => i.status === "value" && inner.append("line").attr("x1", x(i.low)).attr("x2", x(i.high)).attr("y1", y).attr("y2", y)
          .style("stroke", colour(k)).style("stroke-width", thick).style("opacity", thick > 3 ? 0.45 : 1);
        bar(r.bootstrap, 9);
        bar(r.widened, 1.8);
        for (const end of r.widened.status === "value" ? [r.widened.low, r.widened.high] : [])
          inner.append("line").attr("x1", x(end)).attr("x2", x(end)).attr("y1", y - 6).attr("y2", y + 6).style("stroke", colour(k)).style("stroke-width", 1.8);
        inner.append("path").attr("d", symbol(k, 95)).attr("transform", `translate(${x(r.value)},${y})`).style("fill", colour(k));
      });
      return height;
    },
    function () {
      const rows = shownVariants().map(v => {
        const r = v.frontal_crashes_per_million_km, boot = r.bootstrap.status === "value";
        return [v.variant, v.replications, v.vehicle_km, v.frontal_crashes, r.value, r.widened.low, r.widened.high, boot ? r.bootstrap.low : r.bootstrap.status, boot ? r.bootstrap.high : r.bootstrap.status, r.widening.dispersion];
      });
      return {
        summary: shownVariants().map(v => `${v.variant}: ${rate(v.frontal_crashes_per_million_km.value)}`).join("; "),
        columns: ["variant", "replications", "vehicle_km", "frontal_crashes", "per_million_km", "widened_low", "widened_high", "bootstrap_low", "bootstrap_high", "dispersion"],
        rows: rows
      };
    });

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

  // ---- distribution of OLC -----------------------------------------------------------------------

  // Steps of every chosen variant, and the half width of its band where there is one.
  function distributions() {
    return shownVariants().map(v => {
      const e = v.ecdf[state.scope], half = v.olc_g[state.scope].ecdf_band_half_width_1;
      return { variant: indexOf(v.variant), name: v.variant, n: e.n, censored: e.censored, x: e.x, share: e.share, first: e.n ? e.censored / e.n : 0, half: missing(half) ? null : half };
    }).filter(d => d.n > 0);
  }

  const shareAt = (c, x) => { const k = d3.bisectRight(c.x, x); return k ? c.share[k - 1] : c.first; };

  const ecdfFigure = figure("figure-ecdf", "Distribution of OLC",
    () => `Share of ${scopeText()} with an OLC up to the value${distributions().some(c => c.half !== null) ? "; band: 95 % for the whole curve at once, by bootstrap over replications" : "; too few replications for a band"}. A curve that starts above 0 has left-censored vehicles: too little deceleration for an OLC, below every value.`,
    function (svg, width) {
      const curves = distributions();
      const top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: `${c.name} (n = ${c.n}${c.censored ? `, ${c.censored} censored` : ""})` })), lineMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const x = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.x)) || 1]).nice().range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, 1]).range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "OLC, g", "share of vehicles");
      inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0.5)).attr("y2", y(0.5)).style("stroke", "var(--soft)").style("stroke-dasharray", "2 4");
      const steps = c => [[0, c.first], ...c.x.map((value, k) => [value, c.share[k]]), [x.domain()[1], 1]];
      curves.filter(c => c.half !== null).forEach(c => inner.append("path").attr("class", "band")
        .attr("d", d3.area().x(p => x(p[0])).y0(p => y(Math.max(0, p[1] - c.half))).y1(p => y(Math.min(1, p[1] + c.half))).curve(d3.curveStepAfter)(steps(c)))
        .style("fill", colour(c.variant)).style("opacity", 0.14));
      curves.forEach(c => {
        inner.append("path").attr("d", d3.line().x(p => x(p[0])).y(p => y(p[1])).curve(d3.curveStepAfter)(steps(c)))
          .style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]);
        if (c.censored) inner.append("path").attr("d", symbol(c.variant, 60)).attr("transform", `translate(0,${y(c.first)})`).style("fill", colour(c.variant));
      });
      readout(svg, inner, x, y.range()[0], value => [`${fixed(value, 1)} g`, ...curves.map(c => `${c.name}: ${percent(shareAt(c, value))}`)]);
      return height;
    },
    function () {
      const rows = [];
      distributions().forEach(c => {
        const add = (value, share) => rows.push([c.name, value, share, c.half === null ? null : Math.max(0, share - c.half), c.half === null ? null : Math.min(1, share + c.half)]);
        if (c.censored) add(null, c.first);
        c.x.forEach((value, k) => add(value, c.share[k]));
      });
      return { summary: distributions().map(c => `${c.name}: ${c.n} vehicles, ${c.censored} censored`).join("; "), columns: ["variant", "olc_g", "share", "band_low", "band_high"], rows: rows };
    });

  // ---- differences of OLC with their intervals -------------------------------------------------------

  // One row a treatment and measure: {name, what, value, low, high, status}; null bounds are open.
  function differences() {
    const rows = [];
    shownContrasts().forEach(c => {
      const o = c.olc_g;
      [["median", o.median_difference, o.median_interval], ["mean", o.mean_difference, o.mean_interval], ["90 % quantile", o.p90_difference, o.p90_interval]]
        .forEach(([what, e, i]) => rows.push({ name: c.variant, what: `difference of ${what}`, value: missing(e) || e.relation !== "=" ? null : e.value, low: i.low, high: i.high, status: i.status }));
    });
    shownPairs().forEach(c => [["all_pairs", "paired change, avoided = 0 g"], ["conditional_on_crashing", "paired change, conditional on crashing"]].forEach(([key, what]) => {
      const p = c.olc_change_g[key], i = p.hodges_lehmann_interval;
      rows.push({ name: c.variant, what: `${what} (n = ${p.pairs})`, value: p.hodges_lehmann, low: i.low, high: i.high, status: i.status });
    }));
    return rows.filter(r => !missing(r.value));
  }

  const differenceFigure = figure("figure-difference", "Change of OLC against the baseline",
    () => (slice().counterfactual.length ? "Hodges–Lehmann estimate of the change within pairs, of the larger OLC of a crash’s frontally struck vehicles" : "Treatment minus baseline, both at the same mix of scenarios, over all frontally struck vehicles") + `, with 95 % bootstrap intervals over replications; without one, the reason stands beside the value. Means of left-censored vehicles are not known and not drawn. Left of zero: less severe.`,
    function (svg, width) {
      const rows = differences(), margin = { top: 10, right: 16, bottom: 48, left: 16 }, band = 46, h = band * rows.length, w = width - margin.left - margin.right;
      const reach = d3.max(rows, r => d3.max([r.value, r.low, r.high].filter(v => !missing(v)).map(Math.abs))) || 1;
      const x = d3.scaleLinear().domain([-reach, reach]).nice().range([0, w]);
      const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`), ticks = Math.max(3, Math.round(w / 80));
      inner.selectAll(null).data(x.ticks(ticks)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
      inner.append("line").attr("y2", h).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--ink)");
      inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(ticks).tickSizeOuter(0));
      inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("change of OLC, g");
      rows.forEach((r, k) => {
        const v = indexOf(r.name), y = band * (k + 0.5) + 9;
        const label = inner.append("text").attr("class", "over").attr("y", y - 15);
        label.append("tspan").style("font-weight", 600).text(r.name);
        label.append("tspan").attr("class", "soft").text(`  ${r.what}: ${fixed(r.value, 1)} g${width > 460 ? ` (${interval({ status: r.status, low: r.low, high: r.high }, n => fixed(n, 1))})` : ""}`);
        if (r.status === "value") inner.append("line").attr("x1", x(missing(r.low) ? x.domain()[0] : r.low)).attr("x2", x(missing(r.high) ? x.domain()[1] : r.high)).attr("y1", y).attr("y2", y).style("stroke", colour(v)).style("stroke-width", 2.4);
        inner.append("path").attr("d", symbol(v, 80)).attr("transform", `translate(${x(r.value)},${y})`).style("fill", colour(v));
      });
      return margin.top + h + margin.bottom;
    },
    function () {
      const rows = differences().map(r => [r.name, r.what, r.value, r.low, r.high, r.status]);
      return { summary: rows.map(r => `${r[0]}, ${r[1]}: ${fixed(r[2], 1)} g`).join("; "), columns: ["treatment", "change", "olc_g", "low", "high", "interval"], rows: rows };
    });

  // ---- crashes above a severity ------------------------------------------------------------------------

  const above = () => shownVariants().map(v => Object.assign({ variant: indexOf(v.variant), name: v.variant }, v.crashes_above.olc.curve)).filter(c => !missing(c.per_million_km[0]));

  const aboveFigure = figure("figure-above", "Crashes above a severity",
    () => "Frontal crashes whose OLC exceeds the value, per million vehicle-km: rate and severity in one, which a treatment cannot change by moving crashes out of what is looked at. The larger OLC of the frontally struck vehicles of a crash, extrapolated ones included; band: 95 % at each value by itself. The table has how many are certain, and how many possible, if severities outside the validated range count as unknown.",
    function (svg, width) {
      const curves = above(), top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: c.name })), lineMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 66 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const last = d3.max(curves, c => d3.max(c.x.filter((x, k) => c.crashes[k] > 0))) || 1;
      const x = d3.scaleLinear().domain([0, last + 2]).range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.high)) || 1]).nice().range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "OLC, g", "crashes above it per 10⁶ veh-km"), shown = c => c.x.filter(v => v <= last + 2);
      curves.forEach(c => inner.append("path").attr("class", "band").attr("d", d3.area().x(v => x(v)).y0((v, k) => y(c.low[k])).y1((v, k) => y(c.high[k]))(shown(c))).style("fill", colour(c.variant)).style("opacity", 0.16));
      curves.forEach(c => inner.append("path").attr("d", d3.line().x(v => x(v)).y((v, k) => y(c.per_million_km[k]))(shown(c))).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]));
      readout(svg, inner, x, y.range()[0], value => { const k = Math.min(curves[0].x.length - 1, Math.round(value)); return [`above ${k} g`, ...curves.map(c => `${c.name}: ${rate(c.per_million_km[k])} (${rate(c.low[k])} to ${rate(c.high[k])})`)]; });
      return height;
    },
    function () {
      const rows = [];
      above().forEach(c => c.x.forEach((x, k) => rows.push([c.name, x, c.crashes[k], c.at_least[k], c.at_most[k], c.per_million_km[k], c.low[k], c.high[k]])));
      return { summary: shownVariants().map(v => `${v.variant}: ${rate(v.crashes_above.olc.per_million_km)} above ${v.crashes_above.olc.x} g`).join("; "), columns: ["variant", "above_olc_g", "crashes", "at_least", "at_most", "per_million_km", "low", "high"], rows: rows };
    });

  // ---- pairs one by one: OLC without and with the treatment -----------------------------------------

  const inSlice = (columns, k) => (state.scenario === "" || data.scenarios[columns.scenario[k]] === state.scenario) &&
    (state.crashType === "" || data.crash_types[columns.crash_type[k]] === state.crashType);

  // Points {variant, baseline, treated, name}: a crash and what became of it, or a seed run with both.
  function crashPairs() {
    const c = data.pairs.crash;
    return d3.range(c.variant.length).filter(k => state.variants.has(c.variant[k]) && inSlice(c, k)).map(k => ({ variant: c.variant[k], baseline: c.baseline_olc_g[k], treated: c.treated_olc_g[k],
      name: `${data.scenarios[c.scenario[k]]}, ${data.crash_types[c.crash_type[k]]}, ${readable(c.outcome[k])}` }));
  }
  function seedPairs() {
    const c = data.pairs.seed, suffix = state.scope === "inside" ? "_inside" : "", reference = data.variants.findIndex(v => v.is_baseline), points = [];
    const means = d3.rollup(d3.range(c.variant.length).filter(k => inSlice(c, k) && c["vehicles" + suffix][k] > 0),
      ks => d3.sum(ks, k => c["vehicles" + suffix][k] * c["mean_olc_g" + suffix][k]) / d3.sum(ks, k => c["vehicles" + suffix][k]),
      k => c.scenario[k], k => c.number[k], k => c.variant[k]);
    means.forEach((numbers, scenario) => numbers.forEach((own, number) => own.forEach((treated, variant) => {
      if (variant !== reference && state.variants.has(variant) && own.has(reference))
        points.push({ variant: variant, baseline: own.get(reference), treated: treated, name: `${data.scenarios[scenario]}, replication ${number}` });
    })));
    return points;
  }
  const pairs = () => (data.pairs.crash ? crashPairs() : seedPairs());
  const seedsRun = () => d3.sum(data.pairs.seeds.filter((n, k) => !state.scenario || data.scenarios[k] === state.scenario));

  if (data.pairs && data.pairs.crash) document.getElementById("figure-paired").dataset.query = "counterfactual_pairs";
  const pairedFigure = !data.pairs ? null : figure("figure-paired", "OLC without and with the treatment, pair by pair",
    () => (data.pairs.crash
      ? "A point is a frontal crash of the baseline: across its OLC, up what it became with the treatment, 0 when avoided; the larger of its frontally struck vehicles."
      : `A point is a seed run with both: mean OLC over ${scopeText()}, left-censored ones as 0 g. Of ${integer(seedsRun())} seeds, those with such a vehicle in both runs; traffic differs after the first intervention, so a pair is of seeds, not of crashes.`) +
      " Below the line: less severe." + (data.pairs.crash ? thinned() : ""),
    function (svg, width) {
      const points = pairs(), top = legend(svg, width, [...new Set(points.map(p => p.variant))].sort(d3.ascending).map(v => ({ variant: v, label: `${data.variants[v].name} (n = ${points.filter(p => p.variant === v).length}, ${points.filter(p => p.variant === v && p.treated < p.baseline).length} lower)` })), pointMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const reach = d3.max(points, p => Math.max(p.baseline, p.treated)) || 1;
      const x = d3.scaleLinear().domain([0, reach]).nice().range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, reach]).nice().range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "OLC with the baseline, g", "with the treatment, g");
      inner.append("line").attr("x1", x(0)).attr("y1", y(0)).attr("x2", x(x.domain()[1])).attr("y2", y(y.domain()[1])).style("stroke", "var(--ink)").style("stroke-dasharray", "4 4");
      const size = points.length > 500 ? 18 : 38;
      points.forEach(p => inner.append("path").attr("class", "point").attr("d", symbol(p.variant, size)).attr("transform", `translate(${x(p.baseline)},${y(p.treated)})`)
        .style("fill", colour(p.variant)).style("fill-opacity", 0.65).style("stroke", colour(p.variant)).style("stroke-width", 1.1)
        .append("title").text(`${data.variants[p.variant].name}, ${p.name}: ${fixed(p.baseline, 1)} g, with the treatment ${fixed(p.treated, 1)} g`));
      return height;
    },
    function () {
      const points = pairs();
      return { summary: `${points.length} pairs, ${points.filter(p => p.treated < p.baseline).length} less severe with the treatment`, columns: ["treatment", "pair", "baseline_olc_g", "treated_olc_g", "change_g"],
        rows: points.map(p => [data.variants[p.variant].name, p.name, p.baseline, p.treated, p.treated - p.baseline]) };
    });

  // ---- OLC against closing speed -------------------------------------------------------------------

  const scatterFigure = figure("figure-scatter", "OLC against closing speed",
    () => `${scopeText().replace(/^./, c => c.toUpperCase())}; filled: inside the validated range, hollow: extrapolated. Ticks at the bottom: left-censored vehicles.` + thinned(),
    function (svg, width) {
      const rows = chosen().filter(k => vehicles.status[k] !== FAILED);
      const names = data.variants.map((v, k) => ({ variant: k, label: v.name })).filter(n => state.variants.has(n.variant));
      const top = legend(svg, width, names, pointMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const x = d3.scaleLinear().domain([0, d3.max(rows, k => vehicles.closing_speed_km_h[k]) || 1]).nice().range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, d3.max(rows, k => vehicles.olc_g[k]) || 1]).nice().range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "closing speed, km/h", "OLC, g");
      const size = rows.length > 2000 ? 14 : rows.length > 500 ? 24 : 38;
      rows.forEach(k => {
        const v = vehicles.variant[k], inside = vehicles.validity[k] === 0, across = x(vehicles.closing_speed_km_h[k]);
        if (vehicles.status[k] === CENSORED) {
          inner.append("line").attr("x1", across).attr("x2", across).attr("y1", y(0)).attr("y2", y(0) - 10).style("stroke", colour(v)).style("stroke-width", 2);
          return;
        }
        inner.append("path").attr("class", "point").attr("d", symbol(v, size)).attr("transform", `translate(${across},${y(vehicles.olc_g[k])})`)
          .style("fill", inside ? colour(v) : "none").style("fill-opacity", 0.7).style("stroke", colour(v)).style("stroke-width", 1.1)
          .append("title").text(`${data.variants[v].name}, ${data.scenarios[vehicles.scenario[k]]}, ${data.crash_types[vehicles.crash_type[k]]}: ${fixed(vehicles.olc_g[k], 1)} g at ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h, ${readable(data.validity[vehicles.validity[k]])}`);
      });
      return height;
    },
    function () {
      const rows = chosen().filter(k => vehicles.status[k] !== FAILED).map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]],
        data.crash_types[vehicles.crash_type[k]], vehicles.closing_speed_km_h[k], vehicles.olc_g[k], vehicles.status[k] === CENSORED ? "left-censored" : "value", data.validity[vehicles.validity[k]]]);
      return { summary: `${rows.length} vehicles`, columns: ["variant", "scenario", "crash_type", "closing_speed_km_h", "olc_g", "olc_status", "validity"], rows: rows };
    });

  function thinned() {
    const s = data.sample;
    return s.chance < 1 ? ` Drawn: a random sample of about ${integer(Math.round(s.chance * s.frontal_crashes))} of ${integer(s.frontal_crashes)} frontal crashes (seed ${s.seed}); counts, curves and tables use all.` : "";
  }

  // ---- configuration map ---------------------------------------------------------------------------

  const mapRows = () => {
    // One point a crash: the vehicle of role a stands for both.
    return chosen().filter(k => vehicles.role[k] === 0);
  };
  const speedColour = d3.scaleSequential(d3.interpolateViridis).domain([130, 0]).clamp(true);

  const mapFigure = figure("figure-map", "Crash configurations",
    () => "Frontal crashes by lateral offset of the opponent and angle (0° = exactly oncoming, ±90° = crossing), seen from the vehicle struck on its front; colour: closing speed. Filled: that vehicle is inside the validated range." + thinned(),
    function (svg, width) {
      // Treatments of counterfactual pairs were not run: their crashes are no zero.
      const rows = mapRows(), variants = shownVariants().map(v => indexOf(v.variant)), count = variants.length;
      const legendWidth = Math.min(220, width - 120), bar = svg.append("g").attr("transform", "translate(56,4)");
      d3.range(0, 44).forEach(k => bar.append("rect").attr("x", legendWidth * k / 44).attr("width", legendWidth / 44 + 0.5).attr("height", 8).style("fill", speedColour(130 * k / 43)));
      [0, 65, 130].forEach(v => bar.append("text").attr("x", legendWidth * v / 130).attr("y", 22).attr("text-anchor", "middle").text(v === 130 ? "≥ 130 km/h" : v));
      const top = 30, columns = width >= 460 && count > 1 ? 2 : 1, panelWidth = width / columns;
      const margin = { top: 30, right: 14, bottom: 48, left: 56 }, panelHeight = count > columns ? 270 : Math.min(330, 140 + width * 0.35) + 78;
      const extent = d3.max(rows, k => Math.abs(vehicles.lateral_offset_m[k])) || 1;
      const limit = d3.max(rows, k => Math.abs(vehicles.angle_deg[k])) || 1;
      const x = d3.scaleLinear().domain([-extent, extent]).nice().range([0, panelWidth - margin.left - margin.right]);
      const reach = Math.min(180, 45 * Math.ceil(limit / 45)), angles = d3.range(-reach, reach + 1, reach > 45 ? 45 : 15);
      const y = d3.scaleLinear().domain([-reach, reach]).range([panelHeight - margin.top - margin.bottom, 0]);
      variants.forEach((variant, place) => {
        const own = rows.filter(k => vehicles.variant[k] === variant);
        const panel = svg.append("g").attr("transform", `translate(${(place % columns) * panelWidth},${top + Math.floor(place / columns) * panelHeight})`);
        const title = panel.append("text").attr("x", margin.left).attr("y", 18);
        title.append("tspan").style("font-weight", 600).text(data.variants[variant].name);
        title.append("tspan").attr("class", "soft").text(`  ${crashes(own.length)}`);
        const inner = frame(panel, panelWidth, panelHeight, margin, x, y, "lateral offset, m", "angle, °", angles);
        inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0)).attr("y2", y(0)).style("stroke", "var(--soft)");
        inner.append("line").attr("y2", y.range()[0]).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--soft)");
        own.forEach(k => inner.append("path").attr("d", symbol(variant, own.length > 500 ? 16 : 34))
          .attr("transform", `translate(${x(vehicles.lateral_offset_m[k])},${y(vehicles.angle_deg[k])})`)
          .style("fill", vehicles.validity[k] === 0 ? speedColour(vehicles.closing_speed_km_h[k]) : "none").style("fill-opacity", 0.85).style("stroke", speedColour(vehicles.closing_speed_km_h[k])).style("stroke-width", 1.2)
          .append("title").text(`${fixed(vehicles.lateral_offset_m[k], 2)} m, ${fixed(vehicles.angle_deg[k], 0)}°, ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h, ${readable(data.validity[vehicles.validity[k]])}`));
      });
      return top + panelHeight * Math.ceil(count / columns);
    },
    function () {
      const rows = mapRows().map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]], data.crash_types[vehicles.crash_type[k]],
        vehicles.lateral_offset_m[k], vehicles.angle_deg[k], vehicles.closing_speed_km_h[k], data.validity[vehicles.validity[k]]]);
      return { summary: crashes(rows.length, "frontal"), columns: ["variant", "scenario", "crash_type", "lateral_offset_m", "angle_deg", "closing_speed_km_h", "validity"], rows: rows };
    });

  // ---- crash sites on the network --------------------------------------------------------------------

  const siteFigure = figure("figure-sites", "Crash sites",
    () => "Where the first contacts lie, on the lanes of the SUMO network; metres, equal scale both ways." + data.networks.map((n, k) => n.missing ? ` ${readable(data.scenarios[k])}: drawn without its network, ${n.missing}.` : "").join("") + thinned(),
    function (svg, width) {
      const rows = mapRows(), names = data.variants.map((v, k) => ({ variant: k, label: v.name })).filter(n => state.variants.has(n.variant));
      let top = legend(svg, width, names, pointMark) + 6;
      data.scenarios.forEach((name, scenario) => {
        const own = rows.filter(k => vehicles.scenario[k] === scenario);
        if (own.length === 0) return;
        const lanes = data.networks[scenario].lanes || [];
        const x0 = d3.extent(own, k => vehicles.x_m[k]), y0 = d3.extent(own, k => vehicles.y_m[k]);
        const pad = Math.max(25, 0.1 * Math.max(x0[1] - x0[0], y0[1] - y0[0]));
        const box = { x: [x0[0] - pad, x0[1] + pad], y: [y0[0] - pad, y0[1] + pad] };
        const w = width - 16, most = Math.min(420, 0.7 * width), spanX = box.x[1] - box.x[0], spanY = box.y[1] - box.y[0];
        const scale = Math.min(w / spanX, most / spanY), h = Math.max(90, Math.min(most, spanY * scale));
        const cx = (box.x[0] + box.x[1]) / 2, cy = (box.y[0] + box.y[1]) / 2;
        const X = v => 8 + w / 2 + (v - cx) * scale, Y = v => h / 2 - (v - cy) * scale;
        const title = svg.append("text").attr("x", 8).attr("y", top + 12);
        title.append("tspan").style("font-weight", 600).text(readable(name));
        title.append("tspan").attr("class", "soft").text(`  ${crashes(own.length)}`);
        const panel = svg.append("g").attr("transform", `translate(0,${top + 20})`), clip = `clip-${scenario}-${Math.round(width)}`;
        panel.append("clipPath").attr("id", clip).append("rect").attr("x", 8).attr("width", w).attr("height", h);
        panel.append("rect").attr("x", 8).attr("width", w).attr("height", h).style("fill", "none").style("stroke", "var(--line)");
        const roads = panel.append("g").attr("clip-path", `url(#${clip})`);
        lanes.forEach(lane => {
          const points = d3.range(0, lane.length, 2).map(k => `${X(lane[k]).toFixed(1)},${Y(lane[k + 1]).toFixed(1)}`);
          roads.append("polyline").attr("points", points.join(" ")).style("fill", "none").style("stroke", "var(--line)").style("stroke-width", Math.max(1, 3.2 * scale)).style("stroke-linecap", "round");
        });
        own.forEach(k => roads.append("path").attr("class", "site").attr("d", symbol(vehicles.variant[k], own.length > 300 ? 22 : 40))
          .attr("transform", `translate(${X(vehicles.x_m[k])},${Y(vehicles.y_m[k])})`).style("fill", colour(vehicles.variant[k])).style("fill-opacity", 0.65).style("stroke", "var(--surface)").style("stroke-width", 0.5)
          .append("title").text(`${data.variants[vehicles.variant[k]].name}: ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h at ${fixed(vehicles.x_m[k], 0)}, ${fixed(vehicles.y_m[k], 0)}`));
        const unit = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000].filter(m => m * scale < w / 3).pop() || 10;
        panel.append("line").attr("x1", 20).attr("x2", 20 + unit * scale).attr("y1", h - 12).attr("y2", h - 12).style("stroke", "var(--ink)").style("stroke-width", 2);
        panel.append("text").attr("x", 20).attr("y", h - 18).text(`${unit} m`);
        top += h + 34;
      });
      return top;
    },
    function () {
      const rows = mapRows().map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]], data.crash_types[vehicles.crash_type[k]], vehicles.x_m[k], vehicles.y_m[k], vehicles.closing_speed_km_h[k]]);
      return { summary: crashes(rows.length, "frontal"), columns: ["variant", "scenario", "crash_type", "x_m", "y_m", "closing_speed_km_h"], rows: rows };
    });

  // ---- counterfactual outcomes as a flow ----------------------------------------------------------------

  const OUTCOMES = ["avoided", "mitigated", "unchanged", "aggravated", "changed_opponent", "invalid"];
  const OUTCOME_COLOUR = { avoided: "var(--v3)", mitigated: "var(--v1)", unchanged: "var(--v0)", aggravated: "var(--v2)", changed_opponent: "var(--v4)", invalid: "var(--line)" };

  // Crashes of others that the treatment brought about, and those it took away.
  function between(t) {
    const parts = [[t.new_crashes, "new"], [t.vanished_crashes, "vanished"]].filter(p => p[0] > 0).map(p => crashes(p[0], p[1]));
    return parts.length ? ` (${parts.join(" and ")} between others besides)` : "";
  }

  const flowFigure = data.study.design !== "counterfactual" ? null : figure("figure-flow", "What became of the baseline’s frontal crashes",
    () => "Each baseline crash run again from a checkpoint before contact with the treatment on its two vehicles; outcomes by closing speed (±0.5 m/s), they add up to the baseline’s crashes. Shares are of the valid pairs, with 95 % intervals that allow for what replications scatter. The table has the crashes that were inside the validated range with the baseline apart.",
    function (svg, width) {
      const treatments = shownPairs(), panel = 250, left = 92, right = Math.min(290, 0.52 * width);
      treatments.forEach((t, place) => {
        const g = svg.append("g").attr("transform", `translate(0,${place * panel + 22})`), height = panel - 60, scale = (height - 50) / Math.max(1, t.crashes);
        g.append("text").attr("x", 4).attr("y", -6).style("font-weight", 600).text(t.variant + between(t));
        g.append("rect").attr("x", left - 14).attr("width", 14).attr("height", Math.max(1, t.crashes * scale)).style("fill", "var(--v0)");
        g.append("text").attr("x", left - 20).attr("y", t.crashes * scale / 2).attr("text-anchor", "end").text(crashes(t.crashes));
        let from = 0, to = 0;
        const x1 = width - right;
        OUTCOMES.filter(o => t.outcomes[o] > 0).forEach(o => {
          const n = t.outcomes[o], h = n * scale, mid = (left + x1) / 2, share = t.shares[o];
          g.append("path").attr("d", `M${left},${from}C${mid},${from} ${mid},${to} ${x1},${to}V${to + h}C${mid},${to + h} ${mid},${from + h} ${left},${from + h}Z`)
            .style("fill", OUTCOME_COLOUR[o]).style("opacity", 0.45).append("title").text(`${readable(o)}: ${n}`);
          g.append("rect").attr("x", x1).attr("y", to).attr("width", 10).attr("height", Math.max(1, h)).style("fill", OUTCOME_COLOUR[o]);
          const words = g.append("text").attr("x", x1 + 16).attr("y", to + Math.max(h / 2, 4) + 4);
          words.append("tspan").style("font-weight", 600).text(`${readable(o)} ${n}${o === "aggravated" ? ` (by OLC ${t.outcomes_by_olc[o]})` : ""}`);
          if (o !== "invalid") words.append("tspan").attr("class", "soft").text(`  ${percent(n / t.valid)}${share && share.status === "value" && width > 520 ? ` (${interval(share, percent)})` : ""}`);
          from += h;
          to += Math.max(h, 16) + 4;
        });
      });
      return panel * treatments.length;
    },
    function () {
      const rows = [];
      shownPairs().forEach(t => OUTCOMES.forEach(o => rows.push([t.variant, o, t.outcomes[o], t.outcomes_by_olc[o], t.baseline_inside.outcomes[o], o === "invalid" ? null : t.outcomes[o] / t.valid, o === "invalid" ? null : t.shares[o].low, o === "invalid" ? null : t.shares[o].high])));
      return { summary: shownPairs().map(t => `${t.variant}: ${t.outcomes.avoided} of ${t.valid} valid pairs avoided`).join("; "), columns: ["treatment", "outcome", "crashes", "crashes_by_olc", "baseline_inside", "share_of_valid", "low", "high"], rows: rows };
    });

  // ---- expected injuries --------------------------------------------------------------------------------

  function benefits() {
    const rows = [];
    shownContrasts().forEach(c => c.injury_benefit.forEach(b => rows.push(Object.assign({ name: c.variant }, b))));
    shownPairs().forEach(c => c.injury_benefit.forEach(b => rows.push(Object.assign({ name: c.variant }, b))));
    return rows;
  }

  const benefitFigure = figure("figure-benefit", "Benefit in expected injured drivers",
    () => "Per cent fewer injured drivers per vehicle-km than with the baseline (counterfactual: of the same crashes, avoided = 0), by risk function, 95 % bootstrap over replications (none where crashes are too few). Both drivers of the frontal crashes; functions of delta-v, none of OLC. The table has what is left when severities outside the validated range count as unknown.",
    function (svg, width) {
      const rows = benefits().filter(b => !missing(b.benefit_1)), margin = { top: 10, right: 16, bottom: 48, left: 16 }, band = 40, h = band * rows.length, w = width - margin.left - margin.right;
      const low = d3.min(rows, b => d3.min([b.benefit_1, missing(b.interval.low) ? b.benefit_1 : b.interval.low])) || 0;
      const x = d3.scaleLinear().domain([Math.min(0, low), 1]).nice().range([0, w]), inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
      inner.selectAll(null).data(x.ticks(6)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
      inner.append("line").attr("y2", h).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--ink)");
      inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(6).tickFormat(d3.format(".0%")).tickSizeOuter(0));
      inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("fewer expected injured drivers");
      rows.forEach((b, k) => {
        const v = indexOf(b.name), y = band * (k + 0.5) + 8, label = inner.append("text").attr("class", "over").attr("y", y - 13);
        label.append("tspan").style("font-weight", 600).text(b.name);
        label.append("tspan").attr("class", "soft").text(`  ${b.level} (${b.function}): ${percent(b.benefit_1)}${width > 460 ? ` (${interval(b.interval, percent)})` : ""}`);
        if (b.interval.status === "value") inner.append("line").attr("x1", x(missing(b.interval.low) ? x.domain()[0] : b.interval.low)).attr("x2", x(missing(b.interval.high) ? 1 : b.interval.high)).attr("y1", y).attr("y2", y).style("stroke", colour(v)).style("stroke-width", 2.4);
        inner.append("path").attr("d", symbol(v, 70)).attr("transform", `translate(${x(b.benefit_1)},${y})`).style("fill", colour(v));
      });
      return margin.top + h + margin.bottom;
    },
    function () {
      const rows = benefits().map(b => [b.name, b.level, b.function, b.baseline, b.treatment, b.benefit_1, b.interval.low, b.interval.high, b.interval.status, b.bounds_1[0], b.bounds_1[1]]);
      return { summary: rows.map(r => `${r[0]}, ${r[1]} (${r[2]}): ${percent(r[5])}`).join("; "), columns: ["treatment", "level", "function", "expected_baseline", "expected_treatment", "benefit_1", "low", "high", "interval", "at_least", "at_most"], rows: rows };
    });

  // ---- pulse corridors ------------------------------------------------------------------------------------

  const corridors = () => shownVariants().map(v => Object.assign({ variant: indexOf(v.variant), name: v.variant }, v.corridor[state.scope])).filter(c => c.p50.length > 0);
  const STEP_MS = 2;

  const corridorFigure = figure("figure-corridor", "Pulse corridors",
    () => `Deceleration along the car’s x axis over time, CFC60: median and, shaded, the range from 10 to 90 % at each instant, over up to ${data.sample.pulses} sampled vehicles of each variant among ${scopeText()}. From three vehicles on.`,
    function (svg, width) {
      const curves = corridors();
      const top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: `${c.name} (${c.n} pulses)` })), lineMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const x = d3.scaleLinear().domain([0, 150]).range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([Math.min(0, d3.min(curves, c => d3.min(c.p10))), d3.max(curves, c => d3.max(c.p90))]).nice().range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "time from first contact, ms", "deceleration, g");
      curves.forEach(c => inner.append("path").attr("d", d3.area().x((p, k) => x(k * STEP_MS)).y0((p, k) => y(c.p10[k])).y1((p, k) => y(c.p90[k]))(c.p50)).style("fill", colour(c.variant)).style("opacity", 0.16));
      curves.forEach(c => inner.append("path").attr("d", d3.line().x((p, k) => x(k * STEP_MS)).y(y)(c.p50)).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]));
      readout(svg, inner, x, y.range()[0], t => { const k = Math.round(t / STEP_MS); return [`${k * STEP_MS} ms`, ...curves.map(c => k < c.p50.length ? `${c.name}: ${fixed(c.p50[k], 1)} g (${fixed(c.p10[k], 1)} to ${fixed(c.p90[k], 1)})` : `${c.name}: –`)]; });
      return height;
    },
    function () {
      const rows = [];
      corridors().forEach(c => c.p50.forEach((value, k) => rows.push([c.name, k * STEP_MS, c.p10[k], value, c.p90[k], c.n])));
      return { summary: corridors().map(c => `${c.name}: ${c.n} pulses, highest median ${fixed(d3.max(c.p50), 1)} g`).join("; "), columns: ["variant", "time_ms", "p10_g", "median_g", "p90_g", "pulses"], rows: rows };
    });

  // ---- the gallery ---------------------------------------------------------------------------------------

  // Both cars from above at a frame, drawn anew for each position of the slider.
  function drawCrash(area, run, frameNumber) {
    const width = Math.max(240, area.clientWidth), xs = [], ys = [];
    run.vehicles.forEach(v => v.poses.forEach(p => { xs.push(p[0] - 2.6, p[0] + 2.6); ys.push(p[1] - 2.6, p[1] + 2.6); }));
    const x0 = d3.extent(xs), y0 = d3.extent(ys), scale = Math.min(width / (x0[1] - x0[0]), 230 / (y0[1] - y0[0]));
    const height = Math.max(120, scale * (y0[1] - y0[0])), degrees = rad => rad * 180 / Math.PI;
    area.textContent = "";
    const svg = d3.select(area).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height).attr("role", "img")
      .attr("aria-label", `From above, ${fixed(run.times_ms[frameNumber], 0)} ms after first contact`);
    const world = svg.append("g").attr("transform", `translate(${width / 2},${height / 2}) scale(${scale},${-scale}) translate(${-(x0[0] + x0[1]) / 2},${-(y0[0] + y0[1]) / 2})`);
    run.vehicles.forEach((v, role) => {
      const p = v.poses[frameNumber], car = world.append("g").attr("transform", `translate(${p[0]},${p[1]}) rotate(${degrees(p[2])})`);
      v.parts.forEach(part => {
        const f = part.frames[frameNumber];
        car.append("rect").attr("x", -f[3] / 2).attr("y", -part.width_m / 2).attr("width", f[3]).attr("height", part.width_m).attr("rx", part.radius_m)
          .attr("transform", `translate(${f[0]},${f[1]}) rotate(${degrees(f[2])})`).style("fill", `var(--v${role ? 2 : 1})`).style("fill-opacity", part.name === "body" ? 0.18 : 0.55).style("stroke", `var(--v${role ? 2 : 1})`).style("stroke-width", 0.03);
      });
      car.append("text").attr("transform", `rotate(${-degrees(p[2])}) scale(1,-1)`).attr("text-anchor", "middle").attr("dy", "0.35em").style("font-size", "0.7px").style("font-weight", 600).text(v.role);
    });
    svg.append("text").attr("x", 8).attr("y", 18).text(`${fixed(run.times_ms[frameNumber], 0)} ms`);
  }

  function gallery() {
    const parent = document.getElementById("gallery");
    parent.textContent = "";
    const shown = data.gallery.filter(e => state.variants.has(indexOf(e.variant)) && (state.scenario === "" || e.scenario === state.scenario) &&
      (state.crashType === "" || e.crash_type === state.crashType) && (state.scope === "all" || e.inside));
    if (shown.length === 0) element(parent, "p", "No crash of the gallery is in this selection.", { class: "empty" });
    const firstFrames = [];
    shown.forEach(entry => {
      const card = element(parent, "article", undefined, { class: "card crash" });
      card.style.setProperty("--colour", colour(indexOf(entry.variant)));
      element(card, "h3", `${entry.variant}: ${entry.why}`);
      element(card, "p", `${readable(entry.scenario)}, ${entry.crash_type}, crash ${entry.crash_id}${missing(entry.olc_g) ? "" : `, OLC ${fixed(entry.olc_g, 1)} g`}, ${entry.inside ? "inside the validated range" : "outside the validated range: extrapolated"}`, { class: "note" });
      if (!entry.run) { element(card, "p", `Could not be simulated again: ${entry.failed}`, { class: "warning" }); return; }
      const run = entry.run, area = element(card, "div", undefined, { class: "area" }), controls = element(card, "div", undefined, { class: "player" });
      const button = element(controls, "button", "Play", { type: "button", "aria-label": `Play crash ${entry.crash_id}` });
      const slider = element(controls, "input", undefined, { type: "range", min: 0, max: run.times_ms.length - 1, value: 0, "aria-label": `Time in crash ${entry.crash_id}` });
      element(card, "p", `${fixed(run.closing_speed_km_h, 0)} km/h closing, offset ${fixed(run.offset_mm, 0)} mm, angle ${fixed(run.angle_deg, 0)}°. ` + run.vehicles.map(v => `${v.role}: ${readable(v.name)}, delta-v ${fixed(v.severity.delta_v_km_h, 0)} km/h, ${v.severity.olc_status === "value" ? `OLC ${fixed(v.severity.olc_g, 1)} g` : readable(v.severity.olc_status)}`).join("; ") + `. Simulated again when the report was made: ${entry.match}.`, { class: "note" });
      let timer = null;
      const show = k => { slider.value = k; drawCrash(area, run, k); };
      const stop = () => { if (timer) timer.stop(); timer = null; button.textContent = "Play"; };
      slider.oninput = () => { stop(); show(Number(slider.value)); };
      button.onclick = () => {
        if (timer) { stop(); return; }
        let k = Number(slider.value) >= run.times_ms.length - 1 ? 0 : Number(slider.value);
        button.textContent = "Stop";
        timer = d3.interval(() => { if (k >= run.times_ms.length - 1) stop(); else show(++k); }, 70);
      };
      firstFrames.push(() => show(0));
    });
    // Cards have their width only when all of them are there.
    firstFrames.forEach(draw => draw());
  }

  // ---- cards and tables --------------------------------------------------------------------------------

  function cards() {
    const parent = document.getElementById("cards");
    parent.textContent = "";
    shownVariants().forEach(v => {
      const k = indexOf(v.variant);
      const card = element(parent, "article", undefined, { class: "card", "data-variant": v.variant });
      card.style.setProperty("--colour", colour(k));
      const head = element(card, "h3", v.variant), r = v.frontal_crashes_per_million_km, olc = v.olc_g[state.scope];
      element(head, "small", `${v.replications} replications`);
      const list = element(card, "dl");
      const line = (name, value, small, id) => {
        element(list, "dt", name);
        const dd = element(list, "dd", value, id ? { "data-figure": id } : {});
        if (small) element(dd, "small", small);
      };
      line("Exposure, vehicle-km", integer(Math.round(v.vehicle_km)));
      line("Frontal crashes", integer(v.frontal_crashes), undefined, "frontal_crashes");
      line("of these front-front inside range", integer(v.front_front_inside), undefined, "front_front_inside");
      line("Rate per 10⁶ veh-km", rate(r.value), r.interval.status === "value" ? `95 % ${interval(r.interval, rate)}${r.bootstrap.status === "value" ? "" : " (Poisson, widened)"}` : undefined);
      const above = v.crashes_above.olc;
      line(`Above ${above.x} g per 10⁶ veh-km`, rate(above.per_million_km), `${crashes(above.crashes)}; ${interval(above.interval, rate)}`);
      line("Vehicles struck on the front", integer(v.frontal_vehicles), `${percent(v.share_inside_validity)} inside validated range`, "frontal_vehicles");
      line("Median OLC, g", estimate(olc.median, 1), `n = ${olc.n}${olc.censored ? `, ${olc.censored} censored` : ""}`, "median");
    });
    const filtered = state.scenario !== "" || state.crashType !== "";
    document.getElementById("slice-answer").textContent = filtered ? slice().answer : "";
    const total = d3.sum(shownVariants(), v => v.frontal_crashes);
    document.getElementById("status").textContent = `${crashes(total, "frontal")} selected`;
  }

  // A table section with its CSV button and SQL.
  function tableSection(id, query, content) {
    const tools = document.getElementById(`tools-${id}`);
    const button = element(tools, "button", "CSV", { type: "button", "aria-label": `Table ${id} as CSV` });
    button.onclick = () => { const c = content(); download(fileName(id, "csv"), "text/csv", csv(c.columns.map(column => column.name), c.rows)); };
    if (query) sqlDetails(tools, query);
    return function () {
      const parent = document.getElementById(`table-${id}`), c = content();
      parent.textContent = "";
      table(parent, c.caption || "", c.columns, c.rows);
    };
  }

  const quantileTable = tableSection("quantiles", "olc_quantiles", function () {
    const rows = [];
    shownVariants().forEach(v => ["all", "inside"].forEach(scope => {
      const d = v.olc_g[scope];
      rows.push([v.variant, scope === "all" ? "all" : "inside range", d.n, d.censored, estimate(d.mean, 1), fixed(d.sd, 1),
        ...[d.min, d.q25, d.median, d.q75, d.p90, d.p95, d.max].map(e => estimate(e, 1))]);
    }));
    return {
      columns: [{ name: "variant", text: true }, { name: "vehicles", text: true }, ...["n", "censored", "mean", "sd", "min", "25 %", "median", "75 %", "90 %", "95 %", "max"].map(name => ({ name: name }))],
      rows: rows
    };
  });

  const contrastTable = tableSection("contrasts", "", function () {
    const rows = [];
    const two = value => fixed(value, 2), one = value => fixed(value, 1);
    const bounds = (low, high, format) => `${missing(low) ? "−∞" : format(low)} to ${missing(high) ? "∞" : format(high)}`;
    shownContrasts().forEach(c => {
      const o = c.olc_g, speed = c.closing_speed_m_s, dv = c.delta_v_m_s, km_h = n => fixed(3.6 * n, 1);
      const add = (what, value, i, bound, p, holm) => rows.push([c.variant, what, value, i, bound, p, holm]);
      const test = q => missing(q.superiority.p) ? q.superiority.status : (q.superiority.status === "value" ? "" : "≤ ") + pValue(q.superiority.p);
      const change = e => missing(e) ? "–" : (e.relation === "=" ? "" : `${e.relation} `) + km_h(e.value);
      add("rate ratio of frontal crashes", fixed(c.rate_ratio, 2), interval(c.rate_ratio_interval, two), "", pValue(c.rate_p), pValue(c.rate_p_holm));
      [["olc", 1, "g OLC"], ["delta_v", 3.6, "km/h delta-v"]].forEach(([key, factor, unit]) => {
        const r = c.crashes_above[key];
        add(`rate ratio of crashes above ${Number((factor * r.x).toPrecision(6))} ${unit} (${r.crashes[1]} against ${r.crashes[0]})`, fixed(r.ratio, 2), interval(r.interval, two), bounds(r.bound_intervals[0].low, r.bound_intervals[1].high, two), "", "");
      });
      add(`Cliff’s δ of OLC (${o.compared[1]} against ${o.compared[0]} vehicles)`, fixed(o.superiority.cliffs_delta, 2), interval(o.superiority.interval, two), c.olc_bounds.every(b => b.status === "value") ? bounds(c.olc_bounds[0].interval.low, c.olc_bounds[1].interval.high, two) : "–", test(o), pValue(o.p_holm));
      add(`difference in median OLC, g (${estimate(o.medians[1], 1)} against ${estimate(o.medians[0], 1)})`, estimate(o.median_difference, 1), interval(o.median_interval, one), "", "", "");
      add("difference in mean OLC, g", estimate(o.mean_difference, 1), interval(o.mean_interval, one), "", "", "");
      add("difference in 90 % OLC, g", estimate(o.p90_difference, 1), interval(o.p90_interval, one), "", "", "");
      add("largest distance of the distributions of OLC", fixed(o.distance, 2), "", "", missing(o.distance_p) ? "too few" : pValue(o.distance_p), pValue(o.distance_p_holm));
      add("difference in median delta-v, km/h", change(dv.median_difference), interval(dv.median_interval, km_h), "", test(dv), pValue(dv.p_holm));
      add("difference in median closing speed, km/h", change(speed.median_difference), interval(speed.median_interval, km_h), "", test(speed), pValue(speed.p_holm));
    });
    // Crash by crash in the counterfactual design.
    shownPairs().forEach(c => {
      [["all_pairs", "avoided = 0"], ["conditional_on_crashing", "conditional on crashing"]].forEach(([key, which]) => {
        const add = (what, value, i, p, holm) => rows.push([c.variant, `${what}, ${which}`, value, i, "", p, holm]);
        const o = c.olc_change_g[key], v = c.closing_speed_change_m_s[key], km_h = n => fixed(3.6 * n, 1);
        add("change of OLC, g (Hodges–Lehmann, signed rank)", one(o.hodges_lehmann), interval(o.hodges_lehmann_interval, one), pValue(o.signed_rank_p), pValue(o.signed_rank_p_holm));
        add("mean change of OLC, g", one(o.mean), interval(o.mean_interval, one), "", "");
        add("change of closing speed, km/h (Hodges–Lehmann, signed rank)", missing(v.hodges_lehmann) ? "–" : km_h(v.hodges_lehmann), interval(v.hodges_lehmann_interval, km_h), pValue(v.signed_rank_p), pValue(v.signed_rank_p_holm));
      });
    });
    // Pairs have no rates: no column of theirs.
    const paired = slice().counterfactual.length > 0, without = list => paired ? list.filter((v, k) => k !== 4) : list;
    return {
      caption: paired ? "Within pairs, over all valid ones." : "Over all frontally struck vehicles, scenarios mixed alike.",
      columns: without([{ name: "treatment", text: true }, { name: "treatment minus (over) baseline", text: true }, { name: "estimate" }, { name: "95 % interval" }, { name: "95 %, unknown outside" }, { name: "p" }, { name: "p, Holm" }]),
      rows: rows.map(without)
    };
  });

  // The scorecard that ships with the program: a line a class, a column a vehicle.
  const scorecard = d3.csvParse(document.getElementById("scorecard").textContent.trim());
  const scorecardTable = tableSection("scorecard", null, function () {
    const vehicles = Array.from(new Set(scorecard.map(row => row.vehicle)));
    const off = row => {
      const figure = row.bar.startsWith("largest") ? row.max_abs : row.mean_abs;
      if (figure !== "") return `${row.label} ${+figure} ${row.error_unit === "1" ? "" : row.error_unit}`.trim();
      return `${row.label}, ${row.note ? row.note.split(",")[0] : `${+row.model} ${row.unit}`}`;
    };
    const verdict = rows => {
      const judged = rows.filter(row => row.result === "kept" || row.result === "missed"), missed = judged.filter(row => row.result === "missed");
      const compared = rows.filter(row => row.result === "no bar");
      if (!judged.length) return compared.length ? `no bar; off by: ${compared.map(off).join("; ")}` : "–";
      return `${judged.length - missed.length} of ${judged.length}${missed.length ? "; missed: " + missed.map(off).join("; ") : ""}`;
    };
    return {
      columns: [{ name: "crash tests", text: true }, ...vehicles.map(name => ({ name: name, text: true }))],
      rows: Array.from(d3.group(scorecard, row => row.title), ([title, rows]) => [title, ...vehicles.map(name => verdict(rows.filter(row => row.vehicle === name)))])
    };
  });

  const validityTable = tableSection("validity", "validity", function () {
    const counts = new Map();
    d3.range(data.validity_counts.length).forEach(k => {
      const c = data.validity_counts[k];
      if ((state.scenario !== "" && data.scenarios[c.scenario] !== state.scenario) || (state.crashType !== "" && data.crash_types[c.crash_type] !== state.crashType)) return;
      const row = counts.get(c.validity) || data.variants.map(() => 0);
      row[c.variant] += c.vehicles;
      counts.set(c.validity, row);
    });
    const totals = data.variants.map((v, k) => d3.sum(Array.from(counts.values()), row => row[k]));
    const rows = Array.from(counts.entries()).sort((a, b) => (a[0] !== 0) - (b[0] !== 0) || d3.sum(b[1]) - d3.sum(a[1]))
      .map(([validity, row]) => [validity === 0 ? "inside" : `outside: ${readable(data.validity[validity])}`, ...d3.merge(row.map((n, k) => [n, totals[k] ? percent(n / totals[k]) : "–"]))]);
    rows.push(["all frontally struck vehicles", ...d3.merge(totals.map(n => [n, n ? "100 %" : "–"]))]);
    return { columns: [{ name: "validity", text: true }, ...d3.merge(data.variants.map(v => [{ name: v.name }, { name: "share" }]))], rows: rows };
  });

  const injuryTable = tableSection("injuries", "expected_injuries", function () {
    const rows = [];
    shownVariants().forEach(v => v.expected_injured_drivers[state.scope].forEach(i => {
      const risk = data.risks.find(r => r.name === i.function && r.level === i.level);
      rows.push([v.variant, i.level, i.function, i.drivers, i.unknown, fixed(i.expected, 2), rate(i.per_million_km), interval(i.interval, rate), `${risk.source}; ${risk.note}`]);
    }));
    return {
      columns: [{ name: "variant", text: true }, { name: "level", text: true }, { name: "function", text: true }, { name: "drivers" }, { name: "unknown" }, { name: "expected injured" }, { name: "per 10⁶ veh-km" }, { name: "95 % bootstrap" }, { name: "source", text: true }],
      rows: rows
    };
  });

  const precisionTable = tableSection("precision", "", function () {
    const rows = [], line = (name, what, p, replications) => rows.push([name, what, replications, percent(p.relative_1), integer(p.replications_for_10_percent)]);
    shownVariants().forEach(v => {
      line(v.variant, "frontal crash rate", v.frontal_crashes_per_million_km.precision, v.replications);
      line(v.variant, "mean OLC", v.olc_g[state.scope].mean_precision, v.replications);
    });
    shownContrasts().forEach(c => line(c.variant, "rate ratio", c.rate_ratio_precision, c.treatment_replications));
    return { columns: [{ name: "variant", text: true }, { name: "figure", text: true }, { name: "replications" }, { name: "half-width reached" }, { name: "replications in all for ±10 %" }], rows: rows };
  });

  const exposureTable = tableSection("exposure", "exposure_and_rates", function () {
    const rows = [];
    data.scenarios.forEach(name => data.slices.filter(s => s.scenario === name && s.crash_type === null).forEach(s => s.variants.forEach(v =>
      state.variants.has(indexOf(v.variant)) && rows.push([name, v.variant, v.replications, fixed(v.vehicle_km, 1), fixed(v.vehicle_h, 1), v.crashes, v.frontal_crashes, rate(v.frontal_crashes_per_million_km.value), fixed(v.frontal_crashes_per_million_km.widening.dispersion, 2)]))));
    return {
      columns: [{ name: "scenario", text: true }, { name: "variant", text: true }, ...["replications", "vehicle-km", "vehicle-h", "crashes", "frontal", "frontal per 10⁶ km", "dispersion"].map(name => ({ name: name }))],
      rows: rows
    };
  });

  // ---- what does not change with the filters ------------------------------------------------------------

  function facts(parent, pairs) {
    const list = element(parent, "dl", undefined, { class: "facts" });
    pairs.filter(p => !missing(p[1]) && p[1] !== "").forEach(p => { element(list, "dt", p[0]); element(list, "dd", p[1]); });
    return list;
  }

  const settingsText = (object, between) => Object.keys(object || {}).map(name => `${name}${between}${object[name]}`).join(", ");
  const control = c => `${c.model || c.function} (${settingsText(c.parameters, " = ")}${c.equipment ? `; equipment ${settingsText(c.equipment, " ")}` : ""})`;

  function design() {
    const parent = document.getElementById("design"), study = data.study;
    const words = { paired_seeds: "paired seeds: every variant runs the same demand and seeds, replications are compared pair by pair", independent: "independent: every variant has its own seeds", counterfactual: "counterfactual: every crash of the baseline is run again from a checkpoint before contact, with each treatment and once unchanged" };
    facts(parent, [
      ["Design", words[study.design] || study.design],
      ["Replications", `${study.replications} planned per scenario and variant${data.unfinished ? `; ${data.unfinished} not finished and not counted` : ""}`],
      ["Simulated", `${study.duration_s} s each, of these ${study.warmup_s} s warm-up not counted; step ${study.step_length_s} s`],
      ...data.about.scenarios.map(s => [`Driver errors in ${s.name}`, JSON.parse(s.driver_errors).map(control).join("; ") || "none"]),
      ...data.variants.map(v => [`Variant ${v.name}`, v.functions.map(control).join("; ") || "no function"]),
      ...data.backgrounds.map(b => [`Without driver errors, ${b.scenario}`, b.is_known ? b.text + ": the network’s own doing" : "not simulated"]),
      ["Observation", "the frontally struck vehicle; a crash with both fronts struck gives two, kept together with all crashes of their replication in every interval and test"]
    ]);
    data.backgrounds.filter(b => b.warning).forEach(b => element(parent, "p", `Mind: ${b.warning}.`, { class: "warning" }));
    document.getElementById("note-contrasts").textContent = study.design === "counterfactual" ?
      "p by sign flips of whole replications; intervals by bootstrap over replications (BCa), given from 20 replications on, and of shares by counts widened by what replications scatter. Hodges–Lehmann: the median of all means of two changes. Holm’s adjustment covers every p of the table." :
      `Rate: p by ${study.design === "paired_seeds" ? "sign flips of whole seed pairs" : "permutation of whole replications"}, interval by bootstrap over replications or, with fewer than 20 of them, of Poisson counts widened by what they scatter. Severity: Cliff’s δ, the chance that a vehicle of the treatment has the higher OLC minus the chance that it has the lower one, with a test and an interval from its own scatter over replications, which hold when one variant crashes more often; scenarios are compared within themselves. “95 %, unknown outside”: what is left of the interval when severities outside the validated range count as unknown. Holm’s adjustment covers every p of the comparison.`;
  }

  function reproduce() {
    const parent = document.getElementById("reproduce"), about = data.about, study = data.study;
    facts(parent, [
      ["Study file", `${study.name}, SHA-256 ${study.hash}`],
      ["Study seed", data.sample.seed],
      ["Programs", about.versions.map(v => `crashpulse ${v.crashpulse_version}, SUMO ${v.sumo_version} (${v.replications} replications)`).join("; ")],
      ["Vehicle models", about.vehicle_models.map(m => `${m.name}, SHA-256 ${m.hash}`).join("; ")],
      ["Scenarios", about.scenarios.map(s => s.sumocfg).join(", ")],
      ["SUMO’s own reports", about.sumo_collision_check.map(c => `${c.scenario} / ${c.variant}: ${c.reported_by_sumo} colliding pairs, ${c.matched} found as crashes, ${c.explained} explained, ${c.apart ? `${c.apart} with outlines ${c.apart_min_m.toFixed(2)} to ${c.apart_max_m.toFixed(2)} m apart, ` : ""}${c.unexplained} unexplained`).join("; ")]
    ]);
    const seeds = element(parent, "details");
    element(seeds, "summary", `Seeds and configuration hashes of ${about.replications.length} replications`);
    const holder = element(seeds, "div", undefined, { class: "scroll limits-height", tabindex: "0", role: "region", "aria-label": "Seeds and hashes" });
    table(holder, "", ["scenario", "variant", "number", "seed", "status", "configuration_hash"].map(name => ({ name: readable(name), text: true })),
      about.replications.map(r => [r.scenario, r.variant + (r.sweep ? ` [${r.sweep}]` : ""), r.number, r.seed, r.status, r.configuration_hash]));
    const yaml = element(parent, "details");
    element(yaml, "summary", "The study file");
    element(yaml, "pre", study.yaml);
    data.queries.forEach(q => sqlDetails(document.getElementById("queries"), q.name));
  }

  // ---- filters, theme, size ----------------------------------------------------------------------------

  const drawings = [rateFigure, aboveFigure, ecdfFigure, differenceFigure, pairedFigure, scatterFigure, mapFigure, siteFigure, flowFigure, benefitFigure, corridorFigure, gallery].filter(Boolean);
  function update() {
    cards();
    [exposureTable, quantileTable, contrastTable, injuryTable, precisionTable, validityTable, scorecardTable].forEach(draw => draw());
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
  reproduce();
  update();
})();
