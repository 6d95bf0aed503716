// The explorer: fields of a case on the left, its solution by four models on the right. While a slider moves the chosen
// model is solved roughly; when it rests, all of them as exactly as the case asks.
import { Chart, drawBodies, drawMap, measureAgain, sample, significant } from "./charts.js";

const byId = (id) => document.getElementById(id);
const root = document.documentElement.dataset;
const start = await (await fetch("start.json")).json();
const page = crypto.randomUUID();
const MAIN = "quarter-space";
const MODELS = start.models.map((m) => m.name);
const REST = 160; // ms without a move until all models are solved
const PATIENCE = 120; // ms until a solve in flight is dropped for a newer one
const IDLE = 300; // ms without a new drawing until charts out of view are drawn, too

// ---- What is shown.
let state = null; // { name, form, values, flags, profiles }
let revision = 0;
let answers = {}; // by model: { revision, quick, ms, data }
let pinned = null; // { name, answer }
let wantedForm = null; // the form to change to once the newest state has its answer
const view = { body: "block", quantity: "sigma_yy", along: "surface-along-y", down: "depth-end", units: "si", hidden: [] };

const stateOf = (described, form) => ({
  name: described.name, form, values: { ...described[form] }, flags: { ...described.flags },
  profiles: Object.fromEntries(start.bodies.map((b) => [b, described.profiles[b] && { kind: described.profiles[b].kind, file: described.profiles[b].file }])),
});
const kindOf = (body) => (state.profiles[body] ? state.profiles[body].kind : "");
const keysOfKind = (kind) => (start.profiles.find((p) => p.kind === kind) || { keys: [] }).keys;
const profileBody = (key) => (key.table.endsWith(".profile") ? key.table.split(".")[0] : null);
const isShown = (key) => key.forms[state.form] && (!profileBody(key) || keysOfKind(kindOf(profileBody(key))).includes(key.leaf));

// The case as tables, in the form of its file.
function tables() {
  const all = { name: state.name };
  const give = (key, value) => {
    let table = all;
    for (const name of key.table.split(".")) table = table[name] ??= {};
    table[key.leaf] = value;
  };
  for (const key of start.keys) {
    const value = state.values[key.path];
    if (isShown(key) && value !== null && value !== undefined) give(key, value);
  }
  for (const flag of start.flags) if (state.flags[flag.path]) give(flag, true);
  for (const body of start.bodies) {
    const profile = state.profiles[body];
    if (!profile) continue;
    all[body].profile = { ...all[body].profile, kind: profile.kind, ...(profile.file && profile.kind === "table" ? { file: profile.file } : {}) };
  }
  return all;
}

// ---- Fields, one for each key.
const UNITS = { m: ["mm", 1e3], pa: ["GPa", 1e-9], n: ["N", 1], rad: ["mrad", 1e3] };
const unitOf = (key) => {
  const ending = key.leaf.split("_").pop();
  if (ending === "m" && Math.abs(key.example) < 1e-4 && key.example !== 0) return ["\u00b5m", 1e6];
  return (key.leaf.includes("_") && UNITS[ending]) || ["", 1];
};
function labelOf(key) {
  const text = key.what.replace(/ in (metres|pascals|newtons|radians)/, "").replace(/, a fraction of p0$/, "").replace(/^(the|a) /, "").replace(/^(roller|block)'s /, "");
  // A letter alone is a quantity.
  return text[1] === " " ? text : text[0].toUpperCase() + text.slice(1);
}
const TITLES = { load: "Load", dimensionless: "Load and lengths", pose: "How the bodies stand", accuracy: "Accuracy" };
// Tables without part in what is shown; a surface needs its file, which a page does not have.
const UNUSED = ["cells", "fatigue", "surface"];
const titleOf = (table) => (TITLES[table] || table[0].toUpperCase() + table.slice(1).replace(".", ", ")) + (UNUSED.includes(table) ? " (not used here)" : "");
const plain = (v, digits = 6) => significant(v, digits).replace(/\u2212/g, "-");
const fields = new Map();

const slider = {
  limits(key) {
    const s = key.slider;
    const value = state.values[key.path];
    if (s.scale === "length") {
      const ends = lastCase().ends_m;
      const longest = Math.max(...start.bodies.map((b) => ends[b][1] - ends[b][0]));
      const half = Math.max(0.3 * longest, Math.abs(value || 0));
      return [-half, half];
    }
    if (s.scale === "even") return [Math.min(s.low, value ?? s.low), Math.max(s.high, value ?? s.high)];
    const size = Math.abs(value || key.example);
    return [Math.min(s.low, size), Math.max(s.high, size)];
  },
  place(key, value) {
    const [low, high] = slider.limits(key);
    const log = key.slider.scale === "log" || key.slider.scale === "signed";
    return log ? Math.log(Math.abs(value) / low) / Math.log(high / low) : (value - low) / (high - low);
  },
  value(key, place) {
    const [low, high] = slider.limits(key);
    // Rounded down where the limit itself is not legal, as of Poisson's ratio.
    const rounded = (value, by) => {
      const step = (count) => Number((count * by).toPrecision(8));
      const nearest = Math.round(value / by);
      return step(nearest) > key.range[1] ? step(nearest - 1) : step(nearest);
    };
    if (key.slider.scale === "log" || key.slider.scale === "signed") {
      const sign = Math.sign(state.values[key.path] || key.example);
      const size = low * (high / low) ** place;
      return rounded(sign * size, 10 ** (Math.floor(Math.log10(size)) - 3));
    }
    const value = low + place * (high - low);
    return rounded(value, 10 ** Math.floor(Math.log10((high - low) / 500)));
  },
};

function makeField(key) {
  const [unit, factor] = unitOf(key);
  const id = `key-${key.path}`;
  const box = document.createElement("div");
  box.className = "field";
  const isOptional = !key.required && !profileBody(key);
  box.innerHTML = `<div class="line"><label for="${id}"></label><input type="text" inputmode="decimal" id="${id}" data-key="${key.path}"><span class="unit"></span></div><input type="range" min="0" max="1" step="0.005">`;
  const [line, range] = box.children;
  const [label, input, mark] = line.children;
  label.textContent = labelOf(key);
  mark.textContent = unit;
  range.setAttribute("aria-label", `${labelOf(key)}, ${key.table}`);
  range.dataset.key = key.path;
  let check = null;
  if (isOptional) {
    check = document.createElement("input");
    check.type = "checkbox";
    check.dataset.key = key.path;
    check.disabled = key.table === "surface";
    check.setAttribute("aria-label", `Give ${labelOf(key)}`);
    label.prepend(check);
    check.addEventListener("change", () => {
      state.values[key.path] = check.checked ? key.example : null;
      // A tilt is held or free, not both.
      if (check.checked && key.leaf === "eccentricity_m") state.values["pose.tilt_rad"] = null;
      if (check.checked && key.leaf === "tilt_rad") for (const k of start.keys) if (k.leaf === "eccentricity_m") state.values[k.path] = null;
      showFields();
      changed(false);
    });
  }
  const field = {
    key, box, input, range,
    show(but) {
      const value = state.values[key.path];
      const given = value !== null && value !== undefined;
      box.hidden = !isShown(key);
      if (check) check.checked = given;
      for (const e of [input, range]) e.disabled = !given;
      range.hidden = !given;
      input.removeAttribute("aria-invalid");
      if (but !== input) input.value = given ? plain(value * factor) : "";
      if (given && but !== range) range.value = slider.place(key, value);
      range.setAttribute("aria-valuetext", given ? `${plain(value * factor, 4)} ${unit}` : "none");
    },
  };
  range.addEventListener("input", (e) => {
    state.values[key.path] = slider.value(key, Number(range.value));
    field.show(range);
    changed(true, e.timeStamp);
  });
  range.addEventListener("change", () => { field.show(null); });
  input.addEventListener("change", () => {
    const value = Number(input.value.trim().replace(",", ".").replace(/\u2212/g, "-"));
    if (input.value.trim() === "" || !Number.isFinite(value)) {
      complain(`${key.path} = ${input.value.trim() || "nothing"} is not a number; give for example ${plain(key.example * factor)} ${unit}`.trim(), true);
      return;
    }
    state.values[key.path] = Number((value / factor).toPrecision(12));
    field.show(null);
    changed(false);
  });
  fields.set(key.path, field);
  return box;
}

// What is on or off.
function makeFlag(flag) {
  const box = document.createElement("div");
  box.className = "field";
  box.innerHTML = `<label><input type="checkbox" id="key-${flag.path}" data-key="${flag.path}"></label>`;
  const input = box.querySelector("input");
  box.firstChild.append(labelOf(flag));
  input.addEventListener("change", () => { state.flags[flag.path] = input.checked; changed(false); });
  fields.set(flag.path, { box, input, show() { input.checked = Boolean(state.flags[flag.path]); } });
  return box;
}

function makeProfile(body) {
  const box = document.createElement("div");
  box.className = "field";
  box.innerHTML = `<div class="line"><label for="profile-${body}">Profile</label><select id="profile-${body}"></select></div>`;
  const select = box.querySelector("select");
  const own = start.start.profiles[body];
  const kinds = start.profiles.map((p) => p.kind).filter((kind) => kind !== "table" || (own && own.file));
  select.append(new Option("straight", ""), ...kinds.map((kind) => new Option(kind, kind)));
  select.addEventListener("change", () => {
    const kind = select.value;
    state.profiles[body] = kind ? { kind, file: kind === "table" ? own.file : null } : null;
    for (const key of start.keys) {
      if (profileBody(key) !== body) continue;
      const length = lastCase().ends_m[body][1] - lastCase().ends_m[body][0];
      // A straight part that this body has room for.
      const usual = key.leaf === "straight_m" ? Math.min(key.example, Number((0.6 * length).toPrecision(3))) : key.example;
      if (keysOfKind(kind).includes(key.leaf)) state.values[key.path] ??= usual; else state.values[key.path] = null;
    }
    showFields();
    changed(false);
  });
  fields.set(`${body}.profile`, { box, input: select, show() { select.value = kindOf(body); } });
  return box;
}

function makeFields() {
  const groups = new Map();
  const first = ["dimensionless", "load"];
  const keys = [...start.keys].sort((a, b) => first.includes(b.table) - first.includes(a.table));
  for (const key of keys) {
    const name = key.table.split(".")[0];
    if (!groups.has(name)) {
      const group = document.createElement("details");
      group.className = "group";
      group.dataset.table = name;
      group.open = !UNUSED.includes(name) && (innerWidth >= 960 || first.includes(name));
      group.innerHTML = "<summary></summary>";
      group.firstChild.textContent = titleOf(name);
      groups.set(name, group);
    }
    const group = groups.get(name);
    if (profileBody(key) && !fields.has(`${name}.profile`)) group.append(makeProfile(name));
    group.append(makeField(key));
  }
  for (const flag of start.flags) groups.get(flag.table).append(makeFlag(flag));
  byId("groups").append(...groups.values());
}

function showFields() {
  for (const field of fields.values()) field.show(null);
  for (const group of document.querySelectorAll(".group")) {
    group.hidden = ![...group.querySelectorAll(".field")].some((f) => !f.hidden);
  }
  byId("name").value = state.name;
  showForm();
}
const showForm = () => { document.querySelector(`#form input[value="${state.form}"]`).checked = true; };

// ---- Asking for solutions.
let flight = null; // the solve of a moving slider: { abort, since }
let wanted = null; // when the newest move was made that is not solved yet
let resting = 0;
let whole = null; // aborts the solves of a state at rest

async function ask(path, signal, query = {}) {
  const words = new URLSearchParams({ page, state: revision, ...query });
  const response = await fetch(`${path}?${words}`, { method: "POST", signal, headers: { "Content-Type": "application/json" }, body: JSON.stringify(tables()) });
  return answered(response);
}
// Throws what the program says against a case, with the reason.
async function answered(response) {
  const reason = response.ok ? response.headers.get("x-edgeline-refused") : String(response.status);
  if (!reason) return response;
  const { error } = await response.json().catch(() => ({ error: response.statusText }));
  throw Object.assign(new Error(error), { reason });
}

// The state has changed, at `moved` by a slider that may move on.
function changed(isMove, moved = performance.now()) {
  revision += 1;
  root.state = String(revision);
  clearTimeout(resting);
  if (whole) { whole.abort(); whole = null; }
  resting = setTimeout(solveAll, isMove ? REST : 0);
  if (isMove) { wanted = moved; quick(); }
}

async function quick() {
  if (flight) {
    if (performance.now() - flight.since > PATIENCE) flight.abort.abort();
    return;
  }
  const moved = wanted;
  wanted = null;
  const own = { abort: new AbortController(), since: performance.now() };
  flight = own;
  const asked = revision;
  const landed = () => {
    if (flight !== own) return;
    flight = null;
    if (wanted !== null) quick();
  };
  try {
    const data = await (await ask("solve", own.abort.signal, { method: MAIN, coarser: start.quick_tolerance })).json();
    // The program solves the next state while this one is drawn.
    landed();
    answers[MAIN] = { revision: asked, quick: true, data };
    complain(null);
    draw();
    onScreen(moved);
    changeForm();
  } catch (e) {
    if (e.reason === "case") complain(e.message);
  } finally {
    landed();
  }
}

// Measures from the move of a slider until its picture is on the screen.
const painted = new MessageChannel();
let waiting = [];
let moves = [];
painted.port1.onmessage = () => {
  for (const moved of waiting.splice(0)) moves.push(performance.measure("move", { start: moved, end: performance.now() }).duration);
  root.moves = Number(root.moves || 0) + 1;
  if (moves.length > 500) { performance.clearMeasures("move"); moves = moves.slice(-1); }
};
function onScreen(moved) {
  waiting.push(moved);
  requestAnimationFrame(() => painted.port2.postMessage(null));
}

async function solveAll() {
  const own = new AbortController();
  whole = own;
  const asked = revision;
  if (flight) flight.abort.abort();
  wanted = null;
  remember();
  try {
    for (const method of [MAIN, ...MODELS.filter((m) => m !== MAIN)]) {
      const data = await (await ask("solve", own.signal, { method })).json();
      if (asked !== revision) return;
      answers[method] = { revision: asked, quick: false, data };
      complain(null);
      if (method === MAIN) refreshRanges();
      draw();
      changeForm();
      if (asked !== revision) return;
    }
    root.whole = String(asked);
  } catch (e) {
    if (e.name === "AbortError" || e.reason === "replaced") return;
    if (e.reason === "busy" || e.reason === "429") { resting = setTimeout(solveAll, 500); return; }
    complain(e.reason ? e.message : "The program does not answer.");
    if (wantedForm) keepForm();
    root.whole = String(asked);
    draw();
  }
}

// A message that `holds` is about what is not in the case, so that no solution of the case answers it.
let held = null; // the revision whose message holds
function complain(message, holds = false) {
  if (held === revision && !holds) return;
  held = holds ? revision : null;
  const box = byId("message");
  box.hidden = !message;
  box.textContent = message || "";
  byId("kept").hidden = true;
  for (const field of fields.values()) {
    const named = message && field.key && !field.box.hidden && message.includes(field.key.path);
    if (named) field.input.setAttribute("aria-invalid", "true");
  }
  if (message) status();
}
const isMarked = () => [...fields.values()].some((f) => f.key && !f.box.hidden && f.input.getAttribute("aria-invalid") === "true");
const isAnswered = () => Boolean(answers[MAIN]) && answers[MAIN].revision === revision;
// Whether the fields have something that no solution belongs to.
const isRefused = () => !isAnswered() || isMarked();

// ---- The form of the load.
// The program converts: its answer to the newest state has the values of both forms. An older
// answer would undo what has been given since.
function changeForm() {
  if (!wantedForm || !isAnswered()) return;
  const form = wantedForm;
  wantedForm = null;
  take(answers[MAIN].data.case, form);
}
function keepForm() {
  wantedForm = null;
  byId("kept").hidden = false;
  showForm();
}
function askForForm(form) {
  wantedForm = form;
  // What is no number is not in the state, so that no answer tells of it.
  if (held === revision && isMarked()) keepForm();
  else if (isAnswered()) changeForm();
  else changed(false);
}
const lastCase = () => (answers[MAIN] ? answers[MAIN].data.case : start.start);
const refreshRanges = () => { for (const f of fields.values()) if (f.key && f.key.slider.scale === "length" && document.activeElement !== f.range) f.show(f.input); };

// ---- Drawing.
const si = () => view.units === "si";
function units(data) {
  const { c_m, p0_pa } = data.summary.hertz;
  return si() ? { length: 1e3, stress: 1e-6, l: "mm", s: "MPa", c_m, p0_pa } : { length: 1 / c_m, stress: 1 / p0_pa, l: "C", s: "p0", c_m, p0_pa };
}
const SYMBOL = { sigma_xx: "\u03c3xx", sigma_yy: "\u03c3yy", sigma_zz: "\u03c3zz", sigma_xy: "\u03c3xy", sigma_xz: "\u03c3xz", sigma_yz: "\u03c3yz", von_mises: "von Mises", tau_max: "\u03c4max" };
const overlap = (data) => [0, 1].map((i) => Math[i ? "min" : "max"](...start.bodies.map((b) => data.case.ends_m[b][i])));
const alongName = (name) => ({ "surface-along-y": "on the surface", "along-y-0.5C": "0.5 C deep", "along-y-0.78C": "0.78 C deep" })[name] || name;
const downName = (name) => name.replace("depth-", "at ").replace("at centre", "in the middle").replace("at end", "at the end").replace("0.9", "0.9 of the half-length").replace("-x0.7", ", x = 0.7 C").replace("-x1.4", ", x = 1.4 C").replace("-neg", ", \u2212y side");

// Series of all visible models and the pinned state, the main model on top. Each is in units of its
// own C and p0.
function series(of, near) {
  const all = [];
  const add = (name, label, answer, stale) => {
    const found = answer && of(answer.data, units(answer.data));
    if (found) all.push({ name, label, stale, ...found, near: near ? near(found, answer.data, units(answer.data)) : null });
  };
  if (pinned) add("pinned", "pinned", pinned.answer, false);
  for (const name of MODELS) {
    if (name !== MAIN && !view.hidden.includes(name) && answers[name]) add(name, name, answers[name], answers[name].revision !== answers[MAIN].revision || answers[MAIN].quick);
  }
  add(MAIN, MAIN, answers[MAIN], false);
  return all;
}

// A contact that is symmetric has curves on one side alone; the choice of the other side is kept
// until it has them again. Returns the curve to show.
function curveDown(symmetric) {
  const select = byId("down");
  for (const option of select.options) option.hidden = option.disabled = symmetric && option.value.endsWith("-neg");
  select.value = symmetric ? view.down.replace(/-neg$/, "") : view.down;
  return select.value;
}

let charts = null;
function draw() {
  const main = answers[MAIN];
  if (!main) return;
  const { data } = main;
  const u = units(data);
  const times = (v, k) => v.map((x) => x * k);
  const ends = overlap(data);
  const edge = start.edge_c * u.c_m;
  const shades = (data.case.symmetric ? [ends[1]] : ends).map((y) => [(y - edge) * u.length, (y + edge) * u.length]);
  const nearY = (s, d, own) => s.x.map((y) => Math.min(...overlap(d).map((end) => Math.abs(y / own.length - end))) < start.edge_c * own.c_m * (1 - 1e-6));
  const chart = (id, rest) => charts[id].show(rest);
  chart("p-along", { title: "Pressure along the contact, x = 0", xTitle: `y (${u.l})`, yTitle: `p (${u.s})`, shades, unit: u.stress * u.p0_pa,
    series: series((d, own) => ({ x: times(d.pressure["along-y"].at_m, own.length), y: times(d.pressure["along-y"].p_pa, own.stress) }), nearY) });
  chart("p-across", { title: "Pressure across the contact, in the middle", xTitle: `x (${u.l})`, yTitle: `p (${u.s})`, unit: u.stress * u.p0_pa,
    series: series((d, own) => ({ x: times(d.pressure["along-x"].at_m, own.length), y: times(d.pressure["along-x"].p_pa, own.stress) })) });
  const critical = data.summary.critical;
  for (const [place, name, axis] of [["along", view.along, "y"], ["down", curveDown(data.case.symmetric), "z"]]) {
    for (const [which, quantity] of [["stress", view.quantity], ["mises", "von_mises"]]) {
      const of = (d, own) => {
        const curve = d.curves[view.body][name];
        return curve && { x: times(curve.at_m, own.length), y: times(curve.stress_pa[quantity], own.stress), from: curve.from_m };
      };
      const near = (s, d, own) => {
        const within = start.edge_c * own.c_m;
        if (axis === "y") return s.from[2] < within ? nearY(s, d, own) : null;
        const off = Math.min(...overlap(d).map((end) => Math.abs(s.from[1] - end)));
        return off < within ? s.x.map((z) => Math.hypot(off, z / own.length) < within * (1 - 1e-6)) : null;
      };
      const all = series(of, near);
      const from = all.length ? all[all.length - 1].from : null;
      let star = null;
      if (critical && which === "mises" && from && critical.body === view.body) {
        const fixed = axis === "y" ? [0, 2] : [0, 1];
        if (fixed.every((k) => Math.abs(critical.at_m[k] - from[k]) < 1e-5 * u.c_m)) star = [critical.at_m[axis === "y" ? 1 : 2] * u.length, critical.value_pa * u.stress];
      }
      chart(`${which}-${place}`, { title: `${SYMBOL[quantity]}, ${view.body}: ${axis === "y" ? `along, ${alongName(name)}` : `into it, ${downName(name)}`}`,
        xTitle: `${axis} (${u.l})`, yTitle: `${SYMBOL[quantity]} (${u.s})`, shades: axis === "y" ? shades : [], series: all, star, unit: u.stress * u.p0_pa });
    }
  }
  const perLength = (own) => (si() ? 1e-3 : 1 / (own.c_m * own.p0_pa));
  chart("line-load", { title: "Load per length", xTitle: `y (${u.l})`, yTitle: si() ? "q (N/mm)" : "q (C p0)", shades: ends.map((y) => [(y - edge) * u.length, (y + edge) * u.length]),
    series: series((d, own) => ({ x: times(d.line_load.y_m, own.length), y: times(d.line_load.line_load_n_per_m, perLength(own)) }), nearY) });
  drawProfile(data, u);
  drawPictures(data, u);
  tiles(data, u);
  modelsTable(u);
  status();
  clearTimeout(idle);
  idle = setTimeout(paintLate, IDLE);
}
// Charts out of view would cost time while a slider moves. A picture of the whole page, and paper,
// show them.
let idle = 0;
function paintLate() {
  for (const chart of Object.values(charts)) if (chart.late && !chart.card.hidden) chart.paint();
}

function drawProfile(data, u) {
  const bodies = start.bodies.filter((b) => data.case.profiles[b]);
  charts.profile.card.hidden = bodies.length === 0;
  const wide = charts["line-load"].card;
  if (wide.classList.contains("full") !== (bodies.length === 0)) { wide.classList.toggle("full"); measureAgain(); charts["line-load"].show(charts["line-load"].data); }
  if (!bodies.length) return;
  const looks = { roller: MAIN, block: "guilbault" };
  charts.profile.show({ title: `Drop of the profile: ${bodies.join(", ")}`, xTitle: `y (${u.l})`, yTitle: "drop (\u00b5m)", unit: 1,
    series: bodies.map((b) => ({ name: looks[b], label: b, x: data.case.profiles[b].y_m.map((y) => y * u.length), y: data.case.profiles[b].drop_m.map((v) => v * 1e6) })) });
}

let map = null;
function drawPictures(data, u) {
  const s = data.summary;
  const cells = { y: data.map.y_m, dy: data.map.dy_m, dx: data.map.dx_m, p: data.map.p_pa };
  const ends = overlap(data);
  const away = (y) => Math.min(...ends.map((end) => Math.abs(y - end))) >= start.edge_c * u.c_m;
  const most = Math.max(...cells.p.filter((_, j) => away(cells.y[j])).map((row) => Math.max(...row)), 1e-30);
  const critical = s.critical;
  map = drawMap(byId("map"), cells, { most, length: u.length, stress: u.stress, lengthUnit: u.l, stressUnit: u.s, max: s.p_max_at_m, critical: critical && critical.at_m });
  const k = map.stretched;
  byId("map-scale").textContent = `x drawn ${k >= 1 ? significant(k, 2) : `1/${significant(1 / k, 2)}`} times as large as y`;
  const v = data.case.load;
  const radius = v["roller.radius_m"];
  const mm = (x) => `${significant(x * 1e3, 4)} mm`;
  const length = (b) => mm(data.case.ends_m[b][1] - data.case.ends_m[b][0]);
  const width = 2 * Math.max(...data.line_load.half_width_m);
  drawBodies(byId("drawing"), {
    radius, roller: data.case.ends_m.roller, block: data.case.ends_m.block, blockRadius: v["block.radius_m"], tilt: s.tilt_rad, width,
    contact: s.contact_y_m, arm: v["load.eccentricity_m"], critical: critical && { body: critical.body, at: critical.at_m },
    labels: { roller: `roller ${length("roller")}`, block: `block ${length("block")}`, radius: `R ${mm(radius)}`, width: ["contact width", mm(width)] },
  });
}
byId("map").addEventListener("pointermove", (e) => {
  const at = map && map.at(e.clientX, e.clientY);
  const u = answers[MAIN] && units(answers[MAIN].data);
  byId("map-readout").innerHTML = at ? `<span>x = <b>${significant(at.x * u.length, 4)}</b></span><span>y = <b>${significant(at.y * u.length, 4)}</b> ${u.l}</span><span>p = <b>${significant(at.p * u.stress, 4)}</b> ${u.s}</span>` : "";
});
byId("map").addEventListener("pointerleave", () => { byId("map-readout").textContent = ""; });

// What to know of a largest pressure that a singular end leaves without a bound.
const unbounded = (s) => ([s.details.edge, s.details.edge_neg].some((end) => end && end.kind === "singular") ? "a singular end: grows with the resolution" : "");

function tiles(data, u) {
  const s = data.summary;
  // Of the numbers as they are shown: in p0, each in that of its own state.
  const than = (of) => {
    const old = pinned && of(pinned.answer.data.summary) * units(pinned.answer.data).stress;
    if (!old) return "";
    const ratio = of(s) * u.stress / old;
    return `${ratio >= 1 ? "+" : "\u2212"}${significant(Math.abs(ratio - 1) * 100, 3)} % against the pinned, `;
  };
  const place = (at) => at.map((v) => significant(v * u.length, 4)).join(", ");
  const p0 = (v) => (si() ? `${significant(v / u.p0_pa, 4)} p0` : `${significant(v * 1e-6, 4)} MPa`);
  const all = [
    ["p-centre", "Pressure in the middle", s.p_centre_pa * u.stress, u.s, than((of) => of.p_centre_pa) + p0(s.p_centre_pa)],
    ["p-max", "Largest pressure", s.p_max_pa * u.stress, u.s, `${than((of) => of.p_max_pa)}mean of the cell at x, y = ${place(s.p_max_at_m)} ${u.l}${unbounded(s) && `, ${unbounded(s)}`}`],
    ["critical", "Largest von Mises stress", s.critical ? s.critical.value_pa * u.stress : null, u.s, s.critical ? `${than((of) => of.critical && of.critical.value_pa)}on the curves${unbounded(s) && `, ${start.edge_c} C and more from an end`}: ${s.critical.body}, x, y, z = ${place(s.critical.at_m)} ${u.l}` : ""],
    ["hertz", "Hertz: C and p0", null, "", ""],
    ["load", "Load", s.load_n, "N", `W ${significant(data.case.factors["dimensionless.W"], 4)}, S_l ${significant(data.case.factors["dimensionless.S_l"], 4)}, L_r ${significant(data.case.factors["dimensionless.L_r"], 4)}`],
    ["approach", "Approach", s.approach_m * 1e6, "\u00b5m", data.case.symmetric ? `contact from y = ${place(s.contact_y_m)} ${u.l}` : `tilt ${significant(s.tilt_rad * 1e3, 4)} mrad, line of action y = ${significant(s.centre_of_pressure_m[1] * u.length, 4)} ${u.l}`],
  ];
  byId("tiles").innerHTML = all.map(([id, title, value, unit, more]) => (id === "hertz"
    ? `<div class="tile" data-tile="hertz"><h3>${title}</h3><div class="value"><span data-value="c">${significant(u.c_m * 1e3, 4)}</span> <small>mm</small> <span data-value="p0">${significant(u.p0_pa * 1e-6, 4)}</span> <small>MPa</small></div><p>of endless bodies</p></div>`
    : `<div class="tile" data-tile="${id}"><h3>${title}</h3><div class="value"><span data-value="${id}">${significant(value, 5)}</span> <small>${unit}</small></div><p>${more}</p></div>`)).join("");
}

function status() {
  const earlier = !byId("message").hidden && isRefused();
  byId("results").classList.toggle("refused", earlier);
  const main = answers[MAIN];
  if (!main) return;
  const d = main.data.summary;
  const last = moves.length ? `; on the screen ${significant(moves[moves.length - 1], 3)} ms after the last move` : "";
  const whose = earlier ? "Shown is the last case that was solved, not that of the fields: " : "";
  const notes = main.data.notes.map((text) => `; note: ${text}`).join("");
  byId("status").textContent = `${whose}${MAIN}, tolerance ${significant(d.details.tolerance, 2)} p0${main.quick ? " while the slider moves" : ""}: ${d.iterations} iterations, ${significant(d.seconds.total * 1e3, 3)} ms${main.quick ? last : `; ${d.converged ? "converged" : "not converged"}, load met to ${significant(d.load_error_rel, 1)}${last}${notes}`}`;
}

// Largest differences of a model from the main one, in p0.
function differences(name) {
  const [a, b] = [answers[name].data, answers[MAIN].data];
  const p0 = b.summary.hertz.p0_pa;
  const edge = start.edge_c * b.summary.hertz.c_m * (1 - 1e-6);
  const ends = overlap(b);
  let [p, s] = [0, 0];
  const line = b.pressure["along-y"];
  line.at_m.forEach((y, i) => { if (Math.min(...ends.map((e) => Math.abs(e - y))) >= edge) p = Math.max(p, Math.abs(a.pressure["along-y"].p_pa[i] - line.p_pa[i])); });
  for (const body of start.bodies) {
    for (const [curve, c] of Object.entries(b.curves[body])) {
      const other = a.curves[body][curve];
      if (!other) continue;
      const k = "xyz".indexOf(c.axis);
      c.at_m.forEach((v, i) => {
        const at = [...c.from_m];
        at[k] = v;
        if (Math.min(...ends.map((e) => Math.hypot(at[1] - e, at[2]))) < edge) return;
        for (const q of start.quantities.slice(0, 6)) s = Math.max(s, Math.abs(other.stress_pa[q][i] - c.stress_pa[q][i]));
      });
    }
  }
  return [p / p0, s / p0];
}

let rows = "";
function modelsTable(u) {
  // Of a state at rest only: while a slider moves one model is solved.
  const ready = MODELS.filter((m) => answers[m] && !answers[m].quick && answers[m].revision === answers[MAIN].revision);
  if (answers[MAIN].quick) { byId("models").classList.add("stale"); return; }
  byId("models").classList.remove("stale");
  const stamp = `${ready.map((m) => answers[m].revision + m).join()}|${view.units}`;
  if (stamp === rows) return;
  rows = stamp;
  byId("models").tHead.innerHTML = `<tr><th>Model</th><th class="text">What it does</th><th>p in the middle (${u.s})</th><th>largest p of a cell (${u.s})</th><th>largest von Mises (${u.s})</th><th>where: y, z (${u.l})</th><th>p differs by (p0)</th><th>stress differs by (p0)</th><th>ms</th></tr>`;
  const body = byId("models").tBodies[0];
  body.innerHTML = start.models.map(({ name, misses }) => {
    const head = `<td><b>${name}</b></td><td class="text">${misses}</td>`;
    if (!ready.includes(name)) return `<tr data-model="${name}">${head}${"<td>\u2026</td>".repeat(7)}</tr>`;
    const s = answers[name].data.summary;
    const c = s.critical;
    const [dp, ds] = name === MAIN ? [null, null] : differences(name);
    const cells = [significant(s.p_centre_pa * u.stress, 4), `<span title="${unbounded(s)}">${significant(s.p_max_pa * u.stress, 4)}${unbounded(s) && " (grows)"}</span>`, c ? significant(c.value_pa * u.stress, 4) : "\u2013",
      c ? `${c.body} ${significant(c.at_m[1] * u.length, 3)}, ${significant(c.at_m[2] * u.length, 3)}` : "\u2013", dp === null ? "" : significant(dp, 2), ds === null ? "" : significant(ds, 2), significant(s.seconds.total * 1e3, 3)];
    return `<tr data-model="${name}"${name === MAIN ? ' class="main"' : ""}>${head}${cells.map((t) => `<td>${t}</td>`).join("")}</tr>`;
  }).join("");
}

// Which curves are shown; the main model always is.
function legend() {
  const box = (name) => (name === MAIN ? `<span>${sample(name)}${name}</span>`
    : `<label><input type="checkbox" data-model="${name}" ${view.hidden.includes(name) ? "" : "checked"}>${sample(name)}${name}</label>`);
  byId("legend").innerHTML = [...MODELS].reverse().map(box).join("") + (pinned ? `<span>${sample("pinned")}pinned</span>` : "");
  for (const check of byId("legend").querySelectorAll("input")) {
    check.addEventListener("change", () => { view.hidden = check.checked ? view.hidden.filter((m) => m !== check.dataset.model) : [...view.hidden, check.dataset.model]; remember(); draw(); });
  }
}

// ---- The link carries the state.
function remember() {
  const { name, form, values, flags, profiles } = state;
  const given = Object.fromEntries(start.keys.filter((k) => isShown(k) && values[k.path] !== null && values[k.path] !== undefined).map((k) => [k.path, values[k.path]]));
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify({ name, form, values: given, flags, profiles, view }))}`);
}
function recall() {
  try {
    const found = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    if (!["load", "factors"].includes(found.form)) return false;
    const profiles = Object.fromEntries(start.bodies.map((b) => [b, (found.profiles || {})[b] || null]));
    const values = Object.fromEntries(start.keys.map((k) => [k.path, typeof found.values[k.path] === "number" ? found.values[k.path] : null]));
    const flags = Object.fromEntries(start.flags.map((f) => [f.path, (found.flags || {})[f.path] === true]));
    state = { name: String(found.name), form: found.form, values, flags, profiles };
    for (const [name, value] of Object.entries(found.view || {})) if (name in view && typeof value === typeof view[name]) view[name] = value;
    view.hidden = (Array.isArray(view.hidden) ? view.hidden : []).filter((m) => MODELS.includes(m) && m !== MAIN);
    return true;
  } catch { return false; }
}

// ---- Everything around.
function fillChoices() {
  const fill = (id, entries) => {
    const select = byId(id);
    select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
    if (!entries.some(([v]) => v === view[id])) view[id] = entries[0][0];
    select.value = view[id];
    select.onchange = () => { view[id] = select.value; remember(); draw(); };
  };
  fill("body", start.bodies.map((b) => [b, b]));
  fill("quantity", start.quantities.map((q) => [q, SYMBOL[q] || q]));
  fill("along", start.curves.filter((c) => c.includes("along-y")).map((c) => [c, alongName(c)]));
  fill("down", ["depth-end", "depth-0.9", "depth-centre", "depth-end-neg", "depth-0.9-neg"].map((c) => [c, downName(c)]));
  const select = byId("units");
  select.value = view.units = ["si", "c"].includes(view.units) ? view.units : "si";
  select.onchange = () => { view.units = select.value; remember(); draw(); };
  legend();
}

function take(described, form = state.form) {
  state = stateOf(described, form);
  showFields();
  changed(false);
}

async function openFile(file) {
  try {
    if (file.size > 200000) throw new Error("The file is too large for a case.");
    const type = file.name.endsWith(".json") ? "application/json" : "application/toml";
    const words = new URLSearchParams({ page, state: revision, method: MAIN, coarser: start.quick_tolerance });
    const response = await fetch(`solve?${words}`, { method: "POST", headers: { "Content-Type": type }, body: await file.text() });
    const { case: described } = await (await answered(response)).json();
    take(described);
  } catch (e) { complain(e.message, true); }
}

async function download(file) {
  try {
    const blob = await (await ask("file", undefined, { method: MAIN, file })).blob();
    const a = document.createElement("a");
    a.href = URL.createObjectURL(blob);
    a.download = file === "case.toml" ? `${state.name}.toml` : `${state.name}-${file}`;
    a.click();
    setTimeout(() => URL.revokeObjectURL(a.href), 10000);
  } catch (e) { complain(e.message); }
}

function say(button, text) {
  const before = button.textContent;
  button.textContent = text;
  setTimeout(() => { button.textContent = before; }, 1500);
}

function setUp() {
  byId("version").textContent = start.version;
  byId("builtin").append(new Option("Built-in cases\u2026", ""), ...start.cases.map((c) => new Option(c.name, c.name)));
  byId("builtin").addEventListener("change", (e) => { const found = start.cases.find((c) => c.name === e.target.value); e.target.value = ""; if (found) take(found); });
  byId("name").addEventListener("change", (e) => { state.name = e.target.value; changed(false); });
  byId("open").addEventListener("change", (e) => { if (e.target.files[0]) openFile(e.target.files[0]); e.target.value = ""; });
  byId("pin").addEventListener("click", (e) => {
    pinned = pinned || !answers[MAIN] ? null : { answer: answers[MAIN] };
    e.target.setAttribute("aria-pressed", String(Boolean(pinned)));
    e.target.textContent = pinned ? "Unpin" : "Pin";
    legend();
    draw();
  });
  byId("link").addEventListener("click", async (e) => {
    remember();
    try { await navigator.clipboard.writeText(location.href); say(e.target, "Copied"); } catch { say(e.target, "See the address"); }
  });
  byId("files").append(...start.files.map((file) => {
    const item = document.createElement("li");
    item.innerHTML = `<button type="button" data-file="${file}">${file}</button>`;
    item.firstChild.addEventListener("click", () => { byId("downloads").open = false; download(file); });
    return item;
  }));
  addEventListener("click", (e) => { if (!byId("downloads").contains(e.target)) byId("downloads").open = false; });
  addEventListener("keydown", (e) => { if (e.key === "Escape") byId("downloads").open = false; });
  byId("controls").addEventListener("submit", (e) => e.preventDefault());
  for (const radio of document.querySelectorAll("#form input")) {
    radio.addEventListener("change", () => askForForm(radio.value));
  }
  addEventListener("hashchange", () => { if (recall()) { fillChoices(); showFields(); changed(false); } });
  addEventListener("beforeprint", paintLate);
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; measureAgain(); requestAnimationFrame(draw); } });
  const alive = new EventSource("alive");
  alive.onopen = () => { byId("gone").hidden = true; };
  alive.onerror = () => { byId("gone").hidden = false; };
}

charts = Object.fromEntries(["p-along", "p-across", "stress-along", "stress-down", "mises-along", "mises-down", "line-load", "profile"].map((id) => [id, new Chart(byId("charts"), `chart-${id}`, "")]));
state = stateOf(start.start, "load");
setUp();
if (!recall()) state = stateOf(start.start, "load");
makeFields();
fillChoices();
showFields();
changed(false);
root.ready = "yes";
