"use strict";
// The explorer: curves of one case, drawn as SVG from the numbers embedded in the page. It needs only
// points, dashes, a band, a cursor and zoom, so it uses no library.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const chart = byId("chart");
  const controls = { case: byId("case"), body: byId("body"), curve: byId("curve"), quantity: byId("quantity"),
    units: byId("units"), show: byId("show") };
  const SVG = "http://www.w3.org/2000/svg";
  const DASH = { "half-space": "2 4", mirror: "6 4", guilbault: "11 5", "quarter-space": "", "guilbault-cells": "1 3",
    fem: "" };
  const hiddenSources = new Set();
  let view = null; // visible range of the running coordinate, null for all of it
  let cursor = null; // index of the point that is read out

  const element = (name, attributes, text) => {
    const e = document.createElementNS(SVG, name);
    for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
    if (text !== undefined) e.textContent = text;
    return e;
  };
  const engine = (source) => data.references.find((r) => r.name === source);
  const colour = (source) => `var(--c-${engine(source) ? "fem" : source})`;
  // The first reference is the one that errors and differences are taken against; on the points of a
  // file it is the file's curve.
  const first = data.references.length ? data.references[0].name : "FEM";
  const referenceOf = (curve) => curve.reference || first;
  const title = (source) => (engine(source) ? engine(source).title : source);

  function mark(source, x, y) {
    const at = { class: "mark", stroke: colour(source), fill: "none" };
    switch (source) {
      case "half-space": return element("path", { ...at, d: `M${x} ${y - 5}l4.5 8h-9z` });
      case "mirror": return element("path", { ...at, d: `M${x - 4} ${y - 4}l8 8m0 -8l-8 8` });
      case "guilbault": return element("rect", { ...at, x: x - 3.5, y: y - 3.5, width: 7, height: 7 });
      case "quarter-space": return element("circle", { ...at, cx: x, cy: y, r: 4.5 });
      case "guilbault-cells": return element("path", { ...at, d: `M${x} ${y - 5}l5 5l-5 5l-5 -5z` });
      case first: return element("circle", { ...at, fill: colour(source), cx: x, cy: y, r: 2.8 });
      default: return data.brought.includes(source)
        ? element("path", { ...at, d: `M${x - 5} ${y}h10m-5 -5v10` })
        : element("path", { ...at, d: `M${x} ${y - 5}l5 5l-5 5l-5 -5z` });
    }
  }

  const number = (v, digits = 4) => {
    if (v === null || v === undefined || Number.isNaN(v)) return "–";
    return (Object.is(v, -0) ? 0 : v).toFixed(digits).replace("-", "−");
  };

  // What is chosen, in one place.
  function chosen() {
    const caseData = data.cases[controls.case.selectedIndex];
    const key = `${controls.body.value}/${controls.curve.value}`;
    return { caseData, key, curve: caseData.curves[key], quantity: controls.quantity.value };
  }

  function fill(select, entries) {
    const before = select.value;
    select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
    if (entries.some(([value]) => value === before)) select.value = before;
  }

  function refillCurves() {
    const caseData = data.cases[controls.case.selectedIndex];
    const bodies = new Set(Object.keys(caseData.curves).map((k) => k.split("/")[0]));
    fill(controls.body, [...bodies].map((b) => [b, b === "contact" ? "contact (pressure)" : b]));
    const body = controls.body.value;
    const names = Object.keys(caseData.curves).filter((k) => k.startsWith(`${body}/`)).map((k) => k.slice(body.length + 1));
    fill(controls.curve, names.map((n) => [n, n]));
    const quantities = body === "contact" ? ["pressure"] : data.quantities.filter((q) => q !== "pressure");
    fill(controls.quantity, quantities.map((q) => [q, data.symbols[q].replace(" / p0", "")]));
  }

  // Curves of the visible sources as numbers in the chosen units; as differences to the reference on demand.
  function prepare() {
    const { caseData, curve, quantity } = chosen();
    const si = controls.units.value === "si";
    const lengthUnit = si ? caseData.c_m * 1e3 : 1;
    const stressUnit = si ? caseData.p0_pa * 1e-6 : 1;
    const difference = controls.show.value === "difference";
    const reference = referenceOf(curve);
    const fem = curve.values[reference] && curve.values[reference][quantity];
    const series = [];
    for (const source of data.sources) {
      const raw = curve.values[source] && curve.values[source][quantity];
      if (!raw || hiddenSources.has(source)) continue;
      const less = (v, i) => (v === null || !fem || fem[i] === null ? null : v - fem[i]);
      const values = raw.map((v, i) => (difference ? less(v, i) : v)).map((v) => v === null ? null : v * stressUnit);
      series.push({ source, values });
    }
    const band = curve.fem_error && curve.fem_error[quantity];
    return {
      x: curve.at.map((v) => v * lengthUnit), series, difference, stressUnit, lengthUnit, reference,
      band: band ? band.map((v) => v * stressUnit) : null,
      xTitle: si ? `${curve.axis} (mm)` : `${curve.axis} / C`,
      yTitle: (difference ? `difference to ${title(reference)}: ` : "") + (si ? `${data.symbols[quantity].replace(" / p0", "")} (MPa)` : data.symbols[quantity]),
      digitsX: si ? 5 : 3, digitsY: si ? 1 : 4,
    };
  }

  function niceStep(low, high) {
    const rough = (high - low) / 6;
    const decade = 10 ** Math.floor(Math.log10(rough));
    const share = rough / decade;
    return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
  }
  function ticks(low, high) {
    const step = niceStep(low, high);
    const digits = Math.min(8, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
    const all = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) all.push([i * step, number(i * step, digits)]);
    return all;
  }

  const size = { width: 760, height: 440, left: 76, right: 16, top: 14, bottom: 52 };
  let scale = null;

  function draw() {
    // The drawing follows the column's width, so that letters keep their size on a phone.
    size.width = Math.max(320, Math.round(chart.parentElement.clientWidth));
    size.height = Math.round(Math.min(460, Math.max(300, size.width * 0.6)));
    chart.setAttribute("viewBox", `0 0 ${size.width} ${size.height}`);
    const d = prepare();
    const [lo, hi] = [Math.min(...d.x), Math.max(...d.x)];
    const pad = 0.02 * (hi - lo);
    const [x0, x1] = view ? view.map((v) => v * d.lengthUnit) : [lo - pad, hi + pad];
    const visible = d.x.map((v, i) => [v, i]).filter(([v]) => v >= x0 - 1e-12 && v <= x1 + 1e-12).map(([, i]) => i);
    let [y0, y1] = [Infinity, -Infinity];
    const take = (v) => { if (v !== null && Number.isFinite(v)) { y0 = Math.min(y0, v); y1 = Math.max(y1, v); } };
    // Where errors are not counted, values may be singular: the axis need not make room for them,
    // unless nothing else is in view.
    const { caseData, curve, key } = chosen();
    const excluded = key.startsWith("contact") ? data.range.pressure_c[0] : data.range.stress_c;
    const near = curve.points.map((p) => caseData.ends.some((end) => Math.hypot(p[1] - end, p[2]) < excluded * (1 - 1e-6)));
    const counted = visible.filter((i) => !near[i]);
    for (const s of d.series) {
      for (const i of counted.length > 1 ? counted : visible) {
        take(s.values[i]);
        if (s.source === d.reference && d.band && s.values[i] !== null) { take(s.values[i] - d.band[i]); take(s.values[i] + d.band[i]); }
      }
    }
    if (y0 > y1) [y0, y1] = [0, 1];
    // Nothing but rounding is between them, the stress sums' single precision included: a flat line in the middle.
    if (y1 - y0 < Math.max(1e-7, 1e-9 * Math.abs(y1))) { const h = Math.max(1e-3, 0.1 * Math.abs(y1)); y0 -= h; y1 += h; }
    const margin = 0.06 * (y1 - y0);
    y0 -= margin; y1 += margin;
    const box = { left: size.left, right: size.width - size.right, top: size.top, bottom: size.height - size.bottom };
    const px = (v) => box.left + (v - x0) / (x1 - x0) * (box.right - box.left);
    const py = (v) => box.bottom - (v - y0) / (y1 - y0) * (box.bottom - box.top);
    scale = { px, box, x0, x1, d, visible };

    const parts = [];
    const clip = element("clipPath", { id: "inside" });
    clip.append(element("rect", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
    parts.push(clip);
    // A curve over the whole length has two such strips; points in no order have none.
    for (let from = 0, to; curve.joined && from < near.length; from = to + 1) {
      to = from;
      if (!near[from]) continue;
      while (near[to + 1]) to += 1;
      const a = px(from > 0 ? (d.x[from] + d.x[from - 1]) / 2 : d.x[from] - pad);
      const b = px(to + 1 < d.x.length ? (d.x[to] + d.x[to + 1]) / 2 : d.x[to] + pad);
      parts.push(element("rect", { class: "excluded", "clip-path": "url(#inside)", x: Math.min(a, b), y: box.top, width: Math.abs(b - a), height: box.bottom - box.top }));
    }
    for (const [v, text] of ticks(x0, x1)) {
      parts.push(element("line", { class: "grid", x1: px(v), x2: px(v), y1: box.top, y2: box.bottom }));
      parts.push(element("text", { x: px(v), y: box.bottom + 18, "text-anchor": "middle" }, text));
    }
    for (const [v, text] of ticks(y0, y1)) {
      parts.push(element("line", { class: "grid", x1: box.left, x2: box.right, y1: py(v), y2: py(v) }));
      parts.push(element("text", { x: box.left - 8, y: py(v) + 4, "text-anchor": "end" }, text));
    }
    parts.push(element("text", { class: "axis-title", x: (box.left + box.right) / 2, y: size.height - 12, "text-anchor": "middle" }, d.xTitle));
    const middle = (box.top + box.bottom) / 2;
    parts.push(element("text", { class: "axis-title", x: 18, y: middle, "text-anchor": "middle", transform: `rotate(-90 18 ${middle})` }, d.yTitle));
    const layer = element("g", { "clip-path": "url(#inside)" });
    // FEM first: the methods' marks are hollow and leave its points to be seen.
    for (const s of [...d.series].sort((a, b) => Boolean(engine(b.source)) - Boolean(engine(a.source)))) {
      const points = s.values.map((v, i) => (v === null ? null : [px(d.x[i]), py(v), i])).filter(Boolean);
      if (s.source === d.reference && d.band) {
        const up = points.map(([x, , i]) => `${x.toFixed(1)} ${py(s.values[i] + d.band[i]).toFixed(1)}`);
        const down = points.map(([x, , i]) => `${x.toFixed(1)} ${py(s.values[i] - d.band[i]).toFixed(1)}`).reverse();
        layer.append(element("path", { d: `M${[...up, ...down].join("L")}Z`, fill: colour("fem"), opacity: 0.16 }));
      }
      if (!engine(s.source) && points.length > 1 && curve.joined) {
        layer.append(element("path", { class: "curve", "data-source": s.source, stroke: colour(s.source), "stroke-dasharray": DASH[s.source] || "none", d: `M${points.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}` }));
      }
      let last = null;
      for (const [x, y] of points) {
        if (last && Math.hypot(x - last[0], y - last[1]) < (engine(s.source) ? 7 : 12)) continue;
        layer.append(mark(s.source, x, y));
        last = [x, y];
      }
    }
    parts.push(layer);
    parts.push(element("rect", { class: "frame", x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
    if (cursor !== null && cursor < d.x.length && visible.includes(cursor)) {
      parts.push(element("line", { class: "cursor", x1: px(d.x[cursor]), x2: px(d.x[cursor]), y1: box.top, y2: box.bottom }));
    }
    chart.replaceChildren(...parts);
    const what = `${d.yTitle} over ${d.xTitle}: ${caseData.name}, ${key.replace("/", ", ")}`;
    chart.setAttribute("aria-label", what);
    byId("shown").textContent = what;
    readOut(d);
  }

  function sample(source) {
    const svg = element("svg", { width: 44, height: 16, "aria-hidden": "true" });
    if (!engine(source)) svg.append(element("line", { class: "curve", x1: 1, x2: 43, y1: 8, y2: 8, stroke: colour(source), "stroke-dasharray": DASH[source] || "none" }));
    svg.append(mark(source, 22, 8));
    return svg;
  }

  // The table beside the chart: legend, values at the cursor and errors of the whole curve.
  function readOut(d) {
    const { caseData, key, curve, quantity } = chosen();
    const body = byId("readout-rows");
    const reference = d.reference;
    const fem = curve.values[reference] && curve.values[reference][quantity];
    const at = cursor !== null && cursor < d.x.length ? cursor : null;
    const p = at === null ? null : curve.points[at];
    byId("place").classList.toggle("unset", !p);
    byId("place").textContent = p
      ? `x = ${number(p[0], 3)} C, y = ${number(p[1], 3)} C, z = ${number(p[2], 3)} C`
      : "Move over the chart or use the arrow keys for values";
    const errors = (caseData.errors[key] || {})[quantity] || {};
    const rows = data.sources.filter((s) => curve.values[s] && curve.values[s][quantity]).map((source) => {
      const row = document.createElement("tr");
      row.dataset.source = source;
      const name = document.createElement("td");
      const label = document.createElement("label");
      const box = document.createElement("input");
      box.type = "checkbox";
      box.checked = !hiddenSources.has(source);
      box.setAttribute("aria-label", `show ${title(source)}`);
      box.addEventListener("change", () => { if (box.checked) hiddenSources.delete(source); else hiddenSources.add(source); draw(); const again = body.querySelector(`tr[data-source="${CSS.escape(source)}"] input`); if (again) again.focus(); });
      label.append(box, sample(source), title(source));
      name.append(label);
      const cell = (text) => { const c = document.createElement("td"); c.textContent = text; row.append(c); };
      row.append(name);
      const values = curve.values[source][quantity];
      const unit = d.stressUnit;
      cell(at === null ? "" : number(values[at] * unit, d.digitsY));
      const ownError = d.band && at !== null ? `± ${number(d.band[at], d.digitsY)}` : "";
      cell(at === null ? "" : source === reference ? ownError : fem ? number((values[at] - fem[at]) * unit, d.digitsY) : "–");
      const e = errors[source];
      cell(e ? number(e.max * unit, d.digitsY) : source === reference && errors.fem_error_max !== undefined ? `± ${number(errors.fem_error_max * unit, d.digitsY)}` : "");
      cell(e ? number(e.rms * unit, d.digitsY) : "");
      cell(e ? number(e.l1 * unit, d.digitsY) : "");
      return row;
    });
    body.replaceChildren(...rows);
    byId("readout-less").textContent = `less ${title(reference)}`;
    byId("readout-unit").textContent = controls.units.value === "si" ? "MPa" : "fractions of p0";
    fillValues(d);
  }

  // All values as a table, for readers who do not see the chart, and for copying.
  function fillValues(d) {
    const holder = byId("values");
    if (!holder.open) return;
    const table = holder.querySelector("table");
    const { curve, quantity } = chosen();
    const sources = data.sources.filter((s) => curve.values[s] && curve.values[s][quantity]);
    const row = (cells, tag) => { const r = document.createElement("tr"); r.append(...cells.map((c) => { const e = document.createElement(tag); e.textContent = c; return e; })); return r; };
    const head = document.createElement("thead");
    head.append(row([d.xTitle, ...sources.map(title)], "th"));
    const rows = document.createElement("tbody");
    d.x.forEach((x, i) => rows.append(row([number(x, d.digitsX), ...sources.map((s) => number(curve.values[s][quantity][i] * d.stressUnit, d.digitsY))], "td")));
    table.replaceChildren(head, rows);
  }

  function remember() {
    const state = new URLSearchParams();
    for (const [name, select] of Object.entries(controls)) state.set(name, select.value);
    try { history.replaceState(null, "", `#${state}`); } catch { /* some viewers forbid it for files */ }
  }
  function recall() {
    const state = new URLSearchParams(location.hash.slice(1));
    const set = (name) => { const v = state.get(name); if (v !== null && [...controls[name].options].some((o) => o.value === v)) controls[name].value = v; };
    set("case"); refillCurves(); set("body"); refillCurves(); set("curve"); set("quantity"); set("units"); set("show");
  }

  function changed(event) {
    if (event.target === controls.case || event.target === controls.body) refillCurves();
    if (event.target !== controls.units && event.target !== controls.show && event.target !== controls.quantity) { view = null; cursor = null; }
    remember();
    draw();
  }

  function nearest(clientX) {
    const rect = chart.getBoundingClientRect();
    const x = (clientX - rect.left) / rect.width * size.width;
    const value = scale.x0 + (x - scale.box.left) / (scale.box.right - scale.box.left) * (scale.x1 - scale.x0);
    let best = null;
    for (const i of scale.visible) if (best === null || Math.abs(scale.d.x[i] - value) < Math.abs(scale.d.x[best] - value)) best = i;
    return { index: best, value: Math.min(scale.x1, Math.max(scale.x0, value)) / scale.d.lengthUnit };
  }

  let dragFrom = null;
  chart.addEventListener("pointerdown", (e) => { if (e.button === 0) { dragFrom = nearest(e.clientX).value; } });
  chart.addEventListener("pointermove", (e) => {
    const { index, value } = nearest(e.clientX);
    if (index !== cursor || dragFrom !== null) { cursor = index; draw(); }
    if (dragFrom !== null && e.buttons & 1) {
      const [a, b] = [dragFrom, value].map((v) => scale.px(v * scale.d.lengthUnit)).sort((p, q) => p - q);
      chart.append(element("rect", { class: "zoombox", x: a, y: scale.box.top, width: b - a, height: scale.box.bottom - scale.box.top }));
    }
  });
  chart.addEventListener("pointerup", (e) => {
    if (dragFrom === null) return;
    const to = nearest(e.clientX).value;
    const range = [Math.min(dragFrom, to), Math.max(dragFrom, to)];
    dragFrom = null;
    const shown = (scale.x1 - scale.x0) / scale.d.lengthUnit;
    if (range[1] - range[0] > 0.02 * shown) view = range;
    draw();
  });
  chart.addEventListener("pointerleave", () => { dragFrom = null; });
  chart.addEventListener("dblclick", () => { view = null; draw(); });

  function zoom(factor) {
    const { d, x0, x1 } = scale;
    const centre = cursor === null ? (x0 + x1) / 2 : d.x[cursor];
    const half = (x1 - x0) * factor / 2;
    view = [(centre - half) / d.lengthUnit, (centre + half) / d.lengthUnit];
    draw();
  }
  byId("zoom-in").addEventListener("click", () => zoom(0.5));
  byId("zoom-out").addEventListener("click", () => zoom(2));
  byId("zoom-all").addEventListener("click", () => { view = null; draw(); });
  chart.addEventListener("keydown", (e) => {
    const last = chosen().curve.at.length - 1;
    const move = (i) => { cursor = Math.min(last, Math.max(0, i)); };
    switch (e.key) {
      case "ArrowRight": move(cursor === null ? 0 : cursor + 1); break;
      case "ArrowLeft": move(cursor === null ? last : cursor - 1); break;
      case "Home": move(0); break;
      case "End": move(last); break;
      case "+": case "=": zoom(0.5); break;
      case "-": zoom(2); break;
      case "0": case "Escape": view = null; break;
      default: return;
    }
    e.preventDefault();
    draw();
  });

  for (const select of Object.values(controls)) select.addEventListener("change", changed);
  byId("values").addEventListener("toggle", draw);
  const which = byId("effects-method");
  if (which) {
    const show = () => { for (const f of document.querySelectorAll("[data-effects-of]")) f.hidden = f.dataset.effectsOf !== which.value; };
    which.addEventListener("change", show);
    show();
  }
  window.addEventListener("hashchange", () => { recall(); draw(); });
  addEventListener("beforeprint", () => { for (const x of document.querySelectorAll("details")) x.open = true; });
  let waiting = 0;
  new ResizeObserver(() => { cancelAnimationFrame(waiting); waiting = requestAnimationFrame(() => { if (Math.round(chart.parentElement.clientWidth) !== size.width) draw(); }); }).observe(chart.parentElement);

  // What scrolls sideways can be reached, and so scrolled, by keyboard.
  const scrollers = () => {
    for (const e of document.querySelectorAll(".wide, figure")) {
      if (e.scrollWidth > e.clientWidth) e.tabIndex = 0; else e.removeAttribute("tabindex");
    }
  };
  addEventListener("resize", scrollers);
  document.addEventListener("toggle", scrollers, true);

  fill(controls.case, data.cases.map((c) => [c.name, c.label]));
  recall();
  draw();
  scrollers();
  document.documentElement.dataset.ready = "yes";
})();
