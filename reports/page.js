// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const vehicles = data.vehicles;
  const state = { scenario: "", crashType: "", scope: "all" };
  const CENSORED = 1, FAILED = 2;
  const SYMBOLS = [d3.symbolCircle, d3.symbolTriangle, d3.symbolSquare, d3.symbolDiamond, d3.symbolCross, d3.symbolStar];
  const DASHES = [null, "7 3", "2 3", "9 3 2 3", "5 5", "1 4"];

  // ---- words and numbers --------------------------------------------------------------------

  const colour = variant => `var(--v${variant % 6})`;
  const missing = value => value === null || value === undefined;
  const fixed = (value, digits) => missing(value) ? "–" : value.toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "−");
  const integer = value => missing(value) ? "–" : d3.format(",")(value).replace(/,/g, " ");
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

  // Indices of the frontally struck vehicles in the present slice and scope.
  function chosen() {
    const scenario = data.scenarios.indexOf(state.scenario), type = data.crash_types.indexOf(state.crashType);
    return d3.range(vehicles.variant.length).filter(k =>
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
    () => "Frontal crashes per million vehicle-km, of any validity. Thick: 95 % bootstrap over replications, from 20 replications on. Thin: exact Poisson interval, too narrow where replications differ (dispersion above 1).",
    function (svg, width) {
      const rows = slice().variants, margin = { top: 8, right: 16, bottom: 48, left: 16 };
      const band = Math.max(58, Math.min(104, 300 / rows.length)), height = margin.top + band * rows.length + margin.bottom, w = width - margin.left - margin.right;
      const upper = d3.max(rows, v => d3.max([v.frontal_crashes_per_million_km.value, v.frontal_crashes_per_million_km.garwood.high, v.frontal_crashes_per_million_km.bootstrap.high]));
      const x = d3.scaleLinear().domain([0, upper || 1]).nice().range([0, w]);
      const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`), h = band * rows.length;
      const ticks = Math.max(3, Math.round(w / 90));
      inner.selectAll(null).data(x.ticks(ticks)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
      inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(ticks).tickFormat(integer).tickSizeOuter(0));
      inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("frontal crashes per 10⁶ vehicle-km");
      rows.forEach((v, k) => {
        const r = v.frontal_crashes_per_million_km, y = band * (k + 0.5) + 10;
        const label = inner.append("text").attr("y", y - 16);
        label.append("tspan").style("font-weight", 600).text(v.variant);
        label.append("tspan").attr("class", "soft").text(`  ${v.frontal_crashes} crashes in ${integer(Math.round(v.vehicle_km))} veh-km${width < 460 ? "" : `, dispersion ${fixed(r.dispersion, 2)}`}`);
        if (missing(r.value)) return;
        const bar = (i, thick) => i.status === "value" && inner.append("line").attr("x1", x(i.low)).attr("x2", x(i.high)).attr("y1", y).attr("y2", y)
          .style("stroke", colour(k)).style("stroke-width", thick).style("opacity", thick > 3 ? 0.45 : 1);
        bar(r.bootstrap, 9);
        bar(r.garwood, 1.8);
        for (const end of [r.garwood.low, r.garwood.high])
          inner.append("line").attr("x1", x(end)).attr("x2", x(end)).attr("y1", y - 6).attr("y2", y + 6).style("stroke", colour(k)).style("stroke-width", 1.8);
        inner.append("path").attr("d", symbol(k, 95)).attr("transform", `translate(${x(r.value)},${y})`).style("fill", colour(k));
      });
      return height;
    },
    function () {
      const rows = slice().variants.map(v => {
        const r = v.frontal_crashes_per_million_km, boot = r.bootstrap.status === "value";
        return [v.variant, v.replications, v.vehicle_km, v.frontal_crashes, r.value, r.garwood.low, r.garwood.high, boot ? r.bootstrap.low : r.bootstrap.status, boot ? r.bootstrap.high : r.bootstrap.status, r.dispersion];
      });
      return {
        summary: slice().variants.map(v => `${v.variant}: ${rate(v.frontal_crashes_per_million_km.value)}`).join("; "),
        columns: ["variant", "replications", "vehicle_km", "frontal_crashes", "per_million_km", "garwood_low", "garwood_high", "bootstrap_low", "bootstrap_high", "dispersion"],
        rows: rows
      };
    });

  // ---- distribution of OLC -----------------------------------------------------------------------

  // Steps of every variant: share of vehicles with an OLC up to the value; NULL first for censored.
  function distributions() {
    const rows = chosen().filter(k => vehicles.status[k] !== FAILED);
    return data.variants.map((v, variant) => {
      const own = rows.filter(k => vehicles.variant[k] === variant);
      const values = own.filter(k => vehicles.status[k] !== CENSORED).map(k => vehicles.olc_g[k]).sort(d3.ascending);
      const censored = own.length - values.length;
      return { variant: variant, name: v.name, n: own.length, censored: censored, values: values, share: k => (censored + k) / own.length };
    }).filter(d => d.n > 0);
  }

  const ecdfFigure = figure("figure-ecdf", "Distribution of OLC",
    () => `Share of ${scopeText()} with an OLC up to the value. A curve that starts above 0 has left-censored vehicles: too little deceleration for an OLC, below every value.`,
    function (svg, width) {
      const curves = distributions();
      const top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: `${c.name} (n = ${c.n}${c.censored ? `, ${c.censored} censored` : ""})` })), lineMark);
      const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const x = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.values)) || 1]).nice().range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, 1]).range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, "OLC, g", "share of vehicles");
      inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0.5)).attr("y2", y(0.5)).attr("class", "axis").style("stroke", "var(--soft)").style("stroke-dasharray", "2 4");
      curves.forEach(c => {
        const points = [[0, c.share(0)], ...c.values.map((value, k) => [value, c.share(k + 1)]), [x.domain()[1], 1]];
        inner.append("path").attr("d", d3.line().x(p => x(p[0])).y(p => y(p[1])).curve(d3.curveStepAfter)(points))
          .style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]);
        if (c.censored) inner.append("path").attr("d", symbol(c.variant, 60)).attr("transform", `translate(0,${y(c.share(0))})`).style("fill", colour(c.variant));
      });
      return height;
    },
    function () {
      const rows = [];
      distributions().forEach(c => {
        if (c.censored) rows.push([c.name, null, c.share(0)]);
        c.values.forEach((value, k) => rows.push([c.name, value, c.share(k + 1)]));
      });
      return { summary: distributions().map(c => `${c.name}: ${c.n} vehicles, ${c.censored} censored`).join("; "), columns: ["variant", "olc_g", "share"], rows: rows };
    });

  // ---- OLC against closing speed -------------------------------------------------------------------

  const scatterFigure = figure("figure-scatter", "OLC against closing speed",
    () => `${scopeText().replace(/^./, c => c.toUpperCase())}; filled: inside the validated range, hollow: extrapolated. Ticks at the bottom: left-censored vehicles.` + thinned(),
    function (svg, width) {
      const rows = chosen().filter(k => vehicles.status[k] !== FAILED);
      const names = data.variants.map((v, k) => ({ variant: k, label: v.name }));
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
    return data.drawn_every > 1 ? ` Every ${data.drawn_every}th vehicle is drawn; tables use all.` : "";
  }

  // ---- configuration map ---------------------------------------------------------------------------

  const mapRows = () => chosen().filter(k => vehicles.role[k] === 0);

  const mapFigure = figure("figure-map", "Crash configurations",
    () => "Frontal crashes by lateral offset of the opponent and angle (0° = exactly oncoming, ±90° = crossing), seen from the vehicle struck on its front. Filled: that vehicle is inside the validated range." + thinned(),
    function (svg, width) {
      const rows = mapRows(), count = data.variants.length;
      const columns = width >= 460 && count > 1 ? 2 : 1, panelWidth = width / columns;
      const margin = { top: 30, right: 14, bottom: 48, left: 56 }, panelHeight = count > columns ? 270 : Math.min(330, 140 + width * 0.35) + 78;
      const extent = d3.max(rows, k => Math.abs(vehicles.lateral_offset_m[k])) || 1;
      const limit = d3.max(rows, k => Math.abs(vehicles.angle_deg[k])) || 1;
      const x = d3.scaleLinear().domain([-extent, extent]).nice().range([0, panelWidth - margin.left - margin.right]);
      const reach = Math.min(180, 45 * Math.ceil(limit / 45)), angles = d3.range(-reach, reach + 1, reach > 45 ? 45 : 15);
      const y = d3.scaleLinear().domain([-reach, reach]).range([panelHeight - margin.top - margin.bottom, 0]);
      data.variants.forEach((v, variant) => {
        const own = rows.filter(k => vehicles.variant[k] === variant);
        const panel = svg.append("g").attr("transform", `translate(${(variant % columns) * panelWidth},${Math.floor(variant / columns) * panelHeight})`);
        const title = panel.append("text").attr("x", margin.left).attr("y", 18);
        title.append("tspan").style("font-weight", 600).text(v.name);
        title.append("tspan").attr("class", "soft").text(`  ${own.length} crashes`);
        const inner = frame(panel, panelWidth, panelHeight, margin, x, y, "lateral offset, m", "angle, °", angles);
        inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0)).attr("y2", y(0)).style("stroke", "var(--soft)");
        inner.append("line").attr("y2", y.range()[0]).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--soft)");
        own.forEach(k => inner.append("path").attr("d", symbol(variant, own.length > 500 ? 16 : 34))
          .attr("transform", `translate(${x(vehicles.lateral_offset_m[k])},${y(vehicles.angle_deg[k])})`)
          .style("fill", vehicles.validity[k] === 0 ? colour(variant) : "none").style("fill-opacity", 0.7).style("stroke", colour(variant)).style("stroke-width", 1.1)
          .append("title").text(`${fixed(vehicles.lateral_offset_m[k], 2)} m, ${fixed(vehicles.angle_deg[k], 0)}°, ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h, ${readable(data.validity[vehicles.validity[k]])}`));
      });
      return panelHeight * Math.ceil(count / columns);
    },
    function () {
      const rows = mapRows().map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]], data.crash_types[vehicles.crash_type[k]],
        vehicles.lateral_offset_m[k], vehicles.angle_deg[k], vehicles.closing_speed_km_h[k], data.validity[vehicles.validity[k]]]);
      return { summary: `${rows.length} frontal crashes`, columns: ["variant", "scenario", "crash_type", "lateral_offset_m", "angle_deg", "closing_speed_km_h", "validity"], rows: rows };
    });

  // ---- cards and tables --------------------------------------------------------------------------------

  function cards() {
    const parent = document.getElementById("cards");
    parent.textContent = "";
    slice().variants.forEach((v, k) => {
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
      const headline = r.bootstrap.status === "value" ? r.bootstrap : r.garwood;
      line("Rate per 10⁶ veh-km", rate(r.value), headline.status === "value" ? `95 % ${interval(headline, rate)}${headline === r.bootstrap ? "" : " (Poisson)"}` : undefined);
      line("Vehicles struck on the front", integer(v.frontal_vehicles), `${percent(v.share_inside_validity)} inside validated range`, "frontal_vehicles");
      line("Median OLC, g", estimate(olc.median, 1), `n = ${olc.n}${olc.censored ? `, ${olc.censored} censored` : ""}`, "median");
    });
    const filtered = state.scenario !== "" || state.crashType !== "";
    document.getElementById("slice-answer").textContent = filtered ? slice().answer : "";
    const total = d3.sum(slice().variants, v => v.frontal_crashes);
    document.getElementById("status").textContent = `${integer(total)} frontal crashes selected`;
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
    slice().variants.forEach(v => ["all", "inside"].forEach(scope => {
      const d = v.olc_g[scope];
      rows.push([v.variant, scope === "all" ? "all" : "inside range", d.n, d.censored, fixed(d.mean, 1), fixed(d.sd, 1),
        ...[d.min, d.q25, d.median, d.q75, d.p90, d.p95, d.max].map(e => estimate(e, 1))]);
    }));
    return {
      columns: [{ name: "variant", text: true }, { name: "vehicles", text: true }, ...["n", "censored", "mean", "sd", "min", "25 %", "median", "75 %", "90 %", "95 %", "max"].map(name => ({ name: name }))],
      rows: rows
    };
  });

  const contrastTable = tableSection("contrasts", "paired_replications", function () {
    const rows = [];
    const two = value => fixed(value, 2), one = value => fixed(value, 1);
    slice().contrasts.forEach(c => {
      const o = c.olc_g[state.scope];
      const add = (what, value, i, poisson, p, holm) => rows.push([c.variant, what, value, i, poisson, p, holm]);
      add("rate ratio of frontal crashes", fixed(c.rate_ratio, 2), interval(c.rate_ratio_bootstrap, two), interval(c.rate_ratio_poisson, two), pValue(c.rate_p), pValue(c.rate_p_holm));
      add("difference in median OLC, g", estimate(o.median_difference, 1), interval(o.median_interval, one), "", "", "");
      add("difference in mean OLC, g", estimate(o.mean_difference, 1), interval(o.mean_interval, one), "", "", "");
      add("difference in 90 % OLC, g", estimate(o.p90_difference, 1), interval(o.p90_interval, one), "", "", "");
      add("Cliff’s δ of OLC (Mann–Whitney)", fixed(o.cliffs_delta, 2), interval(o.cliffs_delta_interval, two), "", pValue(o.mann_whitney_p), pValue(o.mann_whitney_p_holm));
      add("largest distance of the distributions (KS)", fixed(o.kolmogorov_smirnov_d, 2), "", "", pValue(o.kolmogorov_smirnov_p), "");
    });
    return {
      caption: `OLC over ${scopeText()}.`,
      columns: [{ name: "treatment", text: true }, { name: "treatment minus (over) baseline", text: true }, { name: "estimate" }, { name: "95 % bootstrap" }, { name: "95 % Poisson" }, { name: "p" }, { name: "p, Holm" }],
      rows: rows
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

  const exposureTable = tableSection("exposure", "exposure_and_rates", function () {
    const rows = [];
    data.scenarios.forEach(name => data.slices.filter(s => s.scenario === name && s.crash_type === null).forEach(s => s.variants.forEach(v =>
      rows.push([name, v.variant, v.replications, fixed(v.vehicle_km, 1), fixed(v.vehicle_h, 1), v.crashes, v.frontal_crashes, rate(v.frontal_crashes_per_million_km.value), fixed(v.frontal_crashes_per_million_km.dispersion, 2)]))));
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

  const parameters = object => Object.keys(object || {}).map(name => `${name} = ${object[name]}`).join(", ");

  function design() {
    const parent = document.getElementById("design"), study = data.study;
    const words = { paired_seeds: "paired seeds: every variant runs the same demand and seeds, replications are compared pair by pair", independent: "independent: every variant has its own seeds" };
    facts(parent, [
      ["Design", words[study.design] || study.design],
      ["Replications", `${study.replications} planned per scenario and variant${data.unfinished ? `; ${data.unfinished} not finished and not counted` : ""}`],
      ["Simulated", `${study.duration_s} s each, of these ${study.warmup_s} s warm-up not counted; step ${study.step_length_s} s`],
      ...data.about.scenarios.map(s => [`Driver errors in ${s.name}`, JSON.parse(s.driver_errors).map(e => `${e.model} (${parameters(e.parameters)})`).join("; ") || "none"]),
      ...data.variants.map(v => [`Variant ${v.name}`, v.functions.map(f => `${f.function} (${parameters(f.parameters)})`).join("; ") || "no function"]),
      ["Observation", "the frontally struck vehicle; a crash with both fronts struck gives two, kept together with all crashes of their replication in every interval and test"]
    ]);
    document.getElementById("note-contrasts").textContent = (study.design === "paired_seeds" ?
      "p by sign flips of whole seed pairs" : "p by permutation of whole replications") +
      "; intervals by bootstrap over replications (BCa), given from 20 replications on, and for the rate ratio the interval that holds if counts are Poisson. Cliff’s δ is the chance that a vehicle of the treatment has the higher OLC minus the chance that it has the lower one.";
  }

  function reproduce() {
    const parent = document.getElementById("reproduce"), about = data.about, study = data.study;
    facts(parent, [
      ["Study file", `${study.name}, SHA-256 ${study.hash}`],
      ["Study seed", String(study.seed)],
      ["Programs", about.versions.map(v => `crashpulse ${v.crashpulse_version}, SUMO ${v.sumo_version} (${v.replications} replications)`).join("; ")],
      ["Vehicle models", about.vehicle_models.map(m => `${m.name}, SHA-256 ${m.hash}`).join("; ")],
      ["Scenarios", about.scenarios.map(s => s.sumocfg).join(", ")],
      ["SUMO’s own reports", about.sumo_collision_check.map(c => `${c.scenario} / ${c.variant}: ${c.reported_by_sumo} colliding pairs, ${c.matched} found as crashes, ${c.explained} explained, ${c.unexplained} unexplained`).join("; ")]
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

  const drawings = [rateFigure, ecdfFigure, scatterFigure, mapFigure];
  function update() {
    cards();
    [quantileTable, contrastTable, validityTable].forEach(draw => draw());
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
  design();
  reproduce();
  exposureTable();
  update();
})();
