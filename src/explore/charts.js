// Drawings of the explorer: curves and the bodies as SVG, the pressure as coloured cells. Curves are told
// apart by colour, dash and mark together.
const MINUS = "\u2212";
export const LOOKS = {
  "half-space": { dash: "2 3", mark: "triangle" },
  mirror: { dash: "5 3", mark: "cross" },
  guilbault: { dash: "9 4", mark: "square" },
  "quarter-space": { dash: "", mark: "circle" },
  pinned: { dash: "1 3", mark: "diamond" },
};
const SYMBOLS = { triangle: "\u25b3", cross: "\u00d7", square: "\u25a1", circle: "\u25cb", diamond: "\u25c7" };
export const symbol = (name) => SYMBOLS[LOOKS[name].mark];
export const colour = (name) => `var(--c-${name})`;

// At most some significant digits, as the program writes them.
export function significant(v, digits = 4) {
  if (v === null || v === undefined || !Number.isFinite(v)) return "\u2013";
  if (v === 0) return "0";
  const [mantissa, exponent] = v.toExponential(digits - 1).split("e");
  const e = Number(exponent);
  const bare = (text) => (text.includes(".") ? text.replace(/0+$/, "").replace(/\.$/, "") : text);
  const text = e < -4 || e >= 6 ? `${bare(mantissa)}e${e}` : bare(v.toFixed(Math.max(0, digits - 1 - e)));
  return text.replace(/-/g, MINUS);
}
const escaped = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

function step(low, high, most) {
  const rough = (high - low) / most;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const share = rough / decade;
  return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}
export function ticks(low, high, most = 6) {
  const by = step(low, high, most);
  const digits = Math.min(8, Math.max(0, -Math.floor(Math.log10(by) + 1e-9)));
  const all = [];
  for (let i = Math.ceil(low / by - 1e-9); i * by <= high + 1e-9 * by; i += 1) {
    const v = i * by;
    const text = Math.abs(v) >= 1e5 || (by < 1e-4 && v !== 0) ? significant(v, 3) : v.toFixed(digits).replace(/^-(?=[0.]*$)/, "");
    all.push([v, text.replace(/-/g, MINUS)]);
  }
  return all;
}

function markAt(name, x, y) {
  const [a, b] = [x.toFixed(1), y.toFixed(1)];
  switch (LOOKS[name].mark) {
    case "triangle": return `M${a} ${(y - 5).toFixed(1)}l4.5 8h-9z`;
    case "cross": return `M${(x - 4).toFixed(1)} ${(y - 4).toFixed(1)}l8 8m0 -8l-8 8`;
    case "square": return `M${(x - 3.5).toFixed(1)} ${(y - 3.5).toFixed(1)}h7v7h-7z`;
    case "diamond": return `M${a} ${(y - 5).toFixed(1)}l5 5l-5 5l-5 -5z`;
    default: return `M${(x - 4).toFixed(1)} ${b}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0`;
  }
}
export function sample(name) {
  return `<svg viewBox="0 0 40 16" width="40" height="16" aria-hidden="true"><path class="curve" stroke="${colour(name)}" stroke-dasharray="${LOOKS[name].dash || "none"}" d="M1 8H39"/><path class="mark" stroke="${colour(name)}" d="${markAt(name, 20, 8)}"/></svg>`;
}

// Widths are read once and after the window has changed: each reading lays the page out anew.
let widths = new WeakMap();
export function widthOf(element) {
  if (!widths.has(element)) widths.set(element, element.clientWidth);
  return widths.get(element);
}
export const measureAgain = () => { widths = new WeakMap(); };

// What is out of sight is drawn when it comes into view.
const seen = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    const { chart } = target;
    chart.visible = isIntersecting;
    if (isIntersecting && chart.late) chart.paint();
  }
}, { rootMargin: "100px" });

// Puts parts of a drawing on top of each other, and touches those alone that have changed: laying out text anew is
// what takes a browser longest.
function layers(parent, ...parts) {
  while (parent.children.length > parts.length) parent.lastChild.remove();
  while (parent.children.length < parts.length) parent.append(document.createElementNS("http://www.w3.org/2000/svg", "g"));
  parts.forEach((part, i) => {
    const layer = parent.children[i];
    if (layer.drawn === part) return;
    layer.innerHTML = part;
    layer.drawn = part;
  });
}

// Sets an attribute if it differs: even the same viewBox, set again, lays a drawing out anew.
function set(element, name, value) {
  if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value);
}

let charts = 0;
// One pair of axes in a card of its own. `show` takes series { name, label, x, y, near, stale }, whose points `near` an
// edge the axes need not make room for.
export class Chart {
  constructor(parent, id, title) {
    const card = document.createElement("figure");
    card.className = "card chart";
    card.id = id;
    card.innerHTML = '<figcaption></figcaption><svg role="img" tabindex="0"></svg><output class="readout"></output>';
    parent.append(card);
    this.card = card;
    [this.caption, this.svg, this.out] = card.children;
    this.caption.textContent = title;
    this.clip = `inside-${(charts += 1)}`;
    // Axes, curves, and the frame with the cursor.
    this.svg.innerHTML = `<g></g><g clip-path="url(#${this.clip})"></g><g></g>`;
    this.cursor = null;
    this.data = null;
    this.visible = true;
    this.late = false;
    card.chart = this;
    seen.observe(card);
    this.svg.addEventListener("pointermove", (e) => this.point(this.nearest(e.clientX)));
    this.svg.addEventListener("pointerleave", () => { if (document.activeElement !== this.svg) this.point(null); });
    this.svg.addEventListener("blur", () => this.point(null));
    this.svg.addEventListener("keydown", (e) => this.key(e));
    this.svg.addEventListener("focus", () => { this.out.setAttribute("aria-live", "polite"); if (this.cursor === null) this.point(0); });
  }

  show(data) {
    this.data = data;
    this.late = !this.visible;
    set(this.svg, "aria-label", `${data.title}: ${data.yTitle} over ${data.xTitle}`);
    if (!this.late) this.paint();
  }

  // Draws what is to be shown, in view or not.
  paint() {
    const { data } = this;
    this.late = false;
    if (this.caption.textContent !== data.title) this.caption.textContent = data.title;
    const width = Math.max(260, Math.round(widthOf(this.card) - 24));
    const height = data.height || Math.round(Math.min(250, Math.max(190, width * 0.5)));
    const finite = (s) => s.x.map((_, i) => i).filter((i) => Number.isFinite(s.y[i]));
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const s of data.series) {
      const all = finite(s);
      const counted = all.filter((i) => !(s.near && s.near[i]));
      for (const i of all) { x0 = Math.min(x0, s.x[i]); x1 = Math.max(x1, s.x[i]); }
      for (const i of counted.length > 1 ? counted : all) { y0 = Math.min(y0, s.y[i]); y1 = Math.max(y1, s.y[i]); }
    }
    if (x0 > x1) [x0, x1, y0, y1] = [0, 1, 0, 1];
    if (y1 - y0 < Math.max(1e-12, 1e-6 * Math.abs(y1))) { const h = Math.max(1e-3 * (data.unit || 1), 0.1 * Math.abs(y1)); y0 -= h; y1 += h; }
    const margin = 0.04 * (y1 - y0);
    // Limits that stay where they are while a slider moves a little.
    const by = step(y0, y1, 5) / 2;
    [y0, y1] = [y0 === 0 ? 0 : by * Math.floor((y0 - margin) / by), by * Math.ceil((y1 + margin) / by)];
    const yTicks = ticks(y0, y1, 5);
    const left = 30 + 7 * Math.max(...yTicks.map(([, text]) => text.length));
    const box = { left, right: width - 8, top: 8, bottom: height - 38 };
    const px = (v) => box.left + (v - x0) / (x1 - x0 || 1) * (box.right - box.left);
    const py = (v) => box.bottom - (v - y0) / (y1 - y0) * (box.bottom - box.top);
    this.scale = { px, py, x0, x1, box, width };
    const axes = [`<clipPath id="${this.clip}"><rect x="${box.left}" y="${box.top}" width="${box.right - box.left}" height="${box.bottom - box.top}"/></clipPath>`];
    for (const [from, to] of data.shades || []) {
      const [a, b] = [px(from), px(to)].map((v) => Math.min(box.right, Math.max(box.left, v)));
      if (b > a) axes.push(`<rect class="excluded" x="${a.toFixed(1)}" y="${box.top}" width="${(b - a).toFixed(1)}" height="${box.bottom - box.top}"/>`);
    }
    for (const [v, text] of ticks(x0, x1, Math.max(3, width / 75))) {
      const x = px(v).toFixed(1);
      // All of the last number is inside the drawing.
      const inside = Math.min(x, width - 4 * text.length).toFixed(1);
      axes.push(`<path class="grid" d="M${x} ${box.top}V${box.bottom}"/><text x="${inside}" y="${box.bottom + 16}" text-anchor="middle">${text}</text>`);
    }
    for (const [v, text] of yTicks) {
      const y = py(v).toFixed(1);
      axes.push(`<path class="grid" d="M${box.left} ${y}H${box.right}"/><text x="${box.left - 6}" y="${Number(y) + 4}" text-anchor="end">${text}</text>`);
    }
    const middle = (box.top + box.bottom) / 2;
    axes.push(`<text class="dim" x="${(box.left + box.right) / 2}" y="${height - 4}" text-anchor="middle">${escaped(data.xTitle)}</text>`);
    axes.push(`<text class="dim" text-anchor="middle" transform="translate(12 ${middle}) rotate(-90)">${escaped(data.yTitle)}</text>`);
    const curves = data.series.map((s) => {
      const points = finite(s).map((i) => [px(s.x[i]), py(s.y[i])]);
      const line = points.map(([x, y]) => `${x.toFixed(1)} ${Math.max(-1e4, Math.min(1e4, y)).toFixed(1)}`).join("L");
      const marks = [];
      let last = null;
      for (const [x, y] of points) {
        if (last && Math.hypot(x - last[0], y - last[1]) < 16) continue;
        if (y < -50 || y > height + 50) continue;
        marks.push(markAt(s.name, x, y));
        last = [x, y];
      }
      return `<g data-series="${s.name}"${s.stale ? ' class="stale"' : ""}><path class="curve" stroke="${colour(s.name)}" stroke-dasharray="${LOOKS[s.name].dash || "none"}" d="${line ? `M${line}` : ""}"/><path class="mark" stroke="${colour(s.name)}" d="${marks.join("")}"/></g>`;
    });
    if (data.star) curves.push(`<path class="star" d="${star(px(data.star[0]), py(data.star[1]))}"><title>most stressed place</title></path>`);
    const frame = `<rect class="frame" x="${box.left}" y="${box.top}" width="${box.right - box.left}" height="${box.bottom - box.top}"/><path class="cursor" d=""/>`;
    const [behind, within, before] = this.svg.children;
    set(this.svg, "viewBox", `0 0 ${width} ${height}`);
    layers(behind, axes.join(""));
    layers(within, ...curves);
    layers(before, frame);
    this.point(this.cursor);
  }

  main() { return this.data && this.data.series.length ? this.data.series[this.data.series.length - 1] : null; }

  nearest(clientX) {
    const main = this.main();
    if (!main) return null;
    const rect = this.svg.getBoundingClientRect();
    const x = (clientX - rect.left) / rect.width * this.scale.width;
    let best = 0;
    for (let i = 1; i < main.x.length; i += 1) if (Math.abs(this.scale.px(main.x[i]) - x) < Math.abs(this.scale.px(main.x[best]) - x)) best = i;
    return best;
  }

  // Reads out a point of the uppermost curve, and the others there.
  point(index) {
    this.cursor = index;
    const main = this.main();
    const line = this.svg.querySelector(".cursor");
    if (index === null || !main || index >= main.x.length) {
      this.cursor = null;
      if (line) line.setAttribute("d", "");
      this.out.textContent = "";
      return;
    }
    const at = main.x[index];
    const x = this.scale.px(at).toFixed(1);
    line.setAttribute("d", `M${x} ${this.scale.box.top}V${this.scale.box.bottom}`);
    const here = (s) => { const i = s.x.findIndex((v) => Math.abs(v - at) <= 1e-6 * Math.abs(at) + 1e-9); return i < 0 ? null : s.y[i]; };
    const values = this.data.series.map((s) => [s, here(s)]).filter(([, v]) => v !== null).reverse();
    this.out.innerHTML = `<span>${escaped(this.data.xTitle.replace(" (", " = ").split(" = ")[0])} = <b>${significant(at, 5)}</b></span>` +
      values.map(([s, v]) => `<span data-read="${s.name}"><i class="of-${s.name}">${symbol(s.name)}</i> ${escaped(s.label)} <b>${significant(v, 5)}</b></span>`).join("");
  }

  key(e) {
    const main = this.main();
    if (!main) return;
    const last = main.x.length - 1;
    const to = { ArrowRight: (this.cursor ?? -1) + 1, ArrowLeft: (this.cursor ?? last + 1) - 1, Home: 0, End: last }[e.key];
    if (to === undefined) return;
    e.preventDefault();
    this.point(Math.min(last, Math.max(0, to)));
  }
}

function star(x, y) {
  const points = [];
  for (let i = 0; i < 10; i += 1) {
    const r = i % 2 ? 3.2 : 7.5;
    const a = Math.PI * (i / 5 - 0.5);
    points.push(`${(x + r * Math.cos(a)).toFixed(1)} ${(y + r * Math.sin(a)).toFixed(1)}`);
  }
  return `M${points.join("L")}Z`;
}

// Anchors of viridis (van der Walt and Smith, 2015), whose lightness rises with the value.
const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const PALETTE = Array.from({ length: 256 }, (_, i) => {
  const at = i / 255 * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[low].map((v, k) => Math.round(v + (at - low) * (VIRIDIS[low + 1][k] - v)));
});

// The pressure of all cells, y to the right and x upwards; `most` is the largest value of the colours.
export function drawMap(holder, map, view) {
  const canvas = holder.querySelector("canvas");
  const svg = holder.querySelector("svg");
  const width = Math.max(260, Math.round(widthOf(holder)));
  const height = Math.round(Math.min(300, Math.max(200, width * 0.48)));
  const box = { left: 52, right: width - 84, top: 8, bottom: height - 38 };
  const [wide, high] = [box.right - box.left, box.bottom - box.top].map(Math.round);
  // The browser fills in between: the cells are much larger than a pixel.
  const [nx, ny] = [wide, high].map((pixels) => Math.ceil(pixels / 2));
  const rows = map.y.length;
  const [y0, y1] = [map.y[0] - map.dy[0] / 2, map.y[rows - 1] + map.dy[rows - 1] / 2];
  const reach = map.dx * (Math.max(...map.p.map((row) => row.length)) - 0.5);
  if (canvas.width !== nx || canvas.height !== ny) { canvas.width = nx; canvas.height = ny; }
  // In shares of the axes, which a printer draws in another size than the screen.
  const percent = (v, whole) => `${v / whole * 100}%`;
  Object.assign(canvas.style, { left: percent(box.left, width), top: percent(box.top, height), width: percent(wide, width), height: percent(high, height) });
  const context = canvas.getContext("2d");
  const image = context.createImageData(nx, ny);
  const half = Math.ceil(ny / 2);
  let row = 0;
  const value = (j, at) => {
    const p = map.p[j];
    const i = Math.floor(at);
    const [a, b] = [i < p.length ? p[i] : 0, i + 1 < p.length ? p[i + 1] : 0];
    return a + (at - i) * (b - a);
  };
  for (let i = 0; i < nx; i += 1) {
    const y = y0 + (i + 0.5) / nx * (y1 - y0);
    while (row + 2 < rows && map.y[row + 1] < y) row += 1;
    const next = Math.min(row + 1, rows - 1);
    const share = Math.min(1, Math.max(0, (y - map.y[row]) / (map.y[next] - map.y[row] || 1)));
    for (let j = 0; j < half; j += 1) {
      const at = Math.abs((j + 0.5) / ny * 2 - 1) * reach / map.dx;
      const p = (1 - share) * value(row, at) + share * value(next, at);
      const c = PALETTE[Math.min(255, Math.max(0, Math.round(p / view.most * 255)))];
      for (const k of [4 * (j * nx + i), 4 * ((ny - 1 - j) * nx + i)]) {
        image.data[k] = c[0]; image.data[k + 1] = c[1]; image.data[k + 2] = c[2]; image.data[k + 3] = p > 0 ? 255 : 0;
      }
    }
  }
  context.putImageData(image, 0, 0);
  const px = (y) => box.left + (y - y0) / (y1 - y0) * wide;
  const py = (x) => box.top + (reach - x) / (2 * reach) * high;
  const parts = [`<rect class="frame" x="${box.left}" y="${box.top}" width="${wide}" height="${high}"/>`];
  for (const [v, text] of ticks(y0 * view.length, y1 * view.length, width / 80)) parts.push(`<path class="frame" d="M${px(v / view.length).toFixed(1)} ${box.bottom}v4"/><text x="${px(v / view.length).toFixed(1)}" y="${box.bottom + 17}" text-anchor="middle">${text}</text>`);
  for (const [v, text] of ticks(-reach * view.length, reach * view.length, 5)) parts.push(`<path class="frame" d="M${box.left} ${py(v / view.length).toFixed(1)}h-4"/><text x="${box.left - 7}" y="${(py(v / view.length) + 4).toFixed(1)}" text-anchor="end">${text}</text>`);
  parts.push(`<text class="dim" x="${(box.left + box.right) / 2}" y="${height - 4}" text-anchor="middle">y (${view.lengthUnit})</text>`);
  parts.push(`<text class="dim" text-anchor="middle" transform="translate(11 ${(box.top + box.bottom) / 2}) rotate(-90)">x (${view.lengthUnit})</text>`);
  const bar = box.right + 14;
  PALETTE.forEach((c, i) => { if (i % 8 === 0) parts.push(`<rect x="${bar}" y="${(box.bottom - (i + 8) / 256 * high).toFixed(1)}" width="12" height="${(high / 32 + 0.6).toFixed(1)}" fill="rgb(${c})"/>`); });
  for (const [v, text] of ticks(0, view.most * view.stress, 5)) parts.push(`<text x="${bar + 17}" y="${(box.bottom - v / (view.most * view.stress) * high + 4).toFixed(1)}">${text}</text>`);
  parts.push(`<text class="dim" text-anchor="middle" transform="translate(${width - 3} ${(box.top + box.bottom) / 2}) rotate(-90)">p (${view.stressUnit})</text>`);
  const marks = [];
  const [mx, my] = [px(view.max[1]), py(view.max[0])];
  for (const [stroke, w] of [["#fff", 4], ["#111", 1.6]]) marks.push(`<path fill="none" stroke="${stroke}" stroke-width="${w}" d="M${mx - 7} ${my}h14M${mx} ${my - 7}v14"/>`);
  if (view.critical) marks.push(`<path class="star" d="${star(px(view.critical[1]), py(view.critical[0]))}"><title>most stressed place</title></path>`);
  set(svg, "viewBox", `0 0 ${width} ${height}`);
  set(svg, "aria-label", `Contact pressure over the contact; the cross is its largest value${view.critical ? ", the star the most stressed place" : ""}`);
  layers(svg, parts.join(""), marks.join(""));
  const stretched = (high / (2 * reach)) / (wide / (y1 - y0));
  return {
    stretched,
    at(clientX, clientY) {
      const rect = svg.getBoundingClientRect();
      const [across, down] = [(clientX - rect.left) / rect.width * width, (clientY - rect.top) / rect.height * height];
      const y = y0 + (across - box.left) / wide * (y1 - y0);
      const x = reach - (down - box.top) / high * 2 * reach;
      if (y < y0 || y > y1 || Math.abs(x) > reach) return null;
      let j = 0;
      for (let i = 1; i < rows; i += 1) if (Math.abs(map.y[i] - y) < Math.abs(map.y[j] - y)) j = i;
      return { x: Math.round(x / map.dx) * map.dx, y: map.y[j], p: map.p[j][Math.round(Math.abs(x) / map.dx)] || 0 };
    },
  };
}

// Both bodies to scale, from the side and from the end, with the contact and the most stressed place.
export function drawBodies(svg, it) {
  const width = Math.max(260, Math.round(widthOf(svg.parentElement) - 24));
  const height = Math.round(Math.min(300, Math.max(200, width * 0.48)));
  const r = it.radius;
  const longest = Math.max(it.roller[1] - it.roller[0], 2 * r) * 0.75;
  const cut = it.block.map((v) => Math.max(-longest, Math.min(longest, v)));
  const [y0, y1] = [Math.min(it.roller[0], cut[0]), Math.max(it.roller[1], cut[1])];
  const side = y1 - y0;
  const depth = 0.55 * r;
  const front = 2.5 * r;
  // Room above for words, and for the load's arrow.
  const top = it.arm === null ? 22 : 40;
  const room = height - top - 40;
  // The view from the end has room for its words, however small it is beside a long roller.
  const words = 6.5 * Math.max(...[it.labels.radius, ...it.labels.width].map((text) => text.length));
  const scale = Math.min((width - 66) / (side + front), (width - 66 - words) / side, room / (2 * r + depth));
  const slot = Math.max(front * scale, words);
  const ground = top + 2 * r * scale + (room - (2 * r + depth) * scale) / 2;
  const used = side * scale + slot;
  const start = (width - used - 40) / 2 + 8;
  const sy = (y) => start + (y - y0) * scale;
  const cx = start + side * scale + 40 + slot / 2;
  const f = (v) => v.toFixed(1);
  const parts = [];
  // From the side.
  parts.push(`<rect class="body block" x="${f(sy(cut[0]))}" y="${f(ground)}" width="${f((cut[1] - cut[0]) * scale)}" height="${f(depth * scale)}"/>`);
  for (const [end, i] of [[cut[0], 0], [cut[1], 1]]) if (end !== it.block[i]) parts.push(`<text x="${f(sy(end) + (i ? -14 : 4))}" y="${f(ground + depth * scale / 2 + 4)}">\u2026</text>`);
  const middle = (it.roller[0] + it.roller[1]) / 2;
  parts.push(`<g transform="rotate(${(it.tilt * 180 / Math.PI).toFixed(4)} ${f(sy(middle))} ${f(ground)})"><rect class="body" x="${f(sy(it.roller[0]))}" y="${f(ground - 2 * r * scale)}" width="${f((it.roller[1] - it.roller[0]) * scale)}" height="${f(2 * r * scale)}"/><path class="axis" d="M${f(sy(it.roller[0]) - 6)} ${f(ground - r * scale)}H${f(sy(it.roller[1]) + 6)}"/></g>`);
  parts.push(`<path class="touch" d="M${f(sy(it.contact[0]))} ${f(ground)}H${f(sy(it.contact[1]))}"/>`);
  if (it.arm !== null) parts.push(`<path stroke="var(--ink)" stroke-width="1.6" fill="none" d="M${f(sy(it.arm))} ${f(ground - 2 * r * scale - 16)}v14m-4 -6l4 6l4 -6"/>`);
  // From the end.
  const c = it.blockRadius;
  if (c) {
    const R = c * scale;
    const w = front * scale / 2;
    const sag = Math.abs(R) > w ? Math.abs(R) - Math.sqrt(R * R - w * w) : Math.abs(R);
    const edge = c < 0 ? ground - sag : ground + sag;
    parts.push(`<path class="body block" d="M${f(cx - Math.min(w, Math.abs(R)))} ${f(edge)}A${f(Math.abs(R))} ${f(Math.abs(R))} 0 0 ${c < 0 ? 0 : 1} ${f(cx + Math.min(w, Math.abs(R)))} ${f(edge)}V${f(ground + depth * scale)}H${f(cx - Math.min(w, Math.abs(R)))}Z"/>`);
  } else {
    parts.push(`<rect class="body block" x="${f(cx - front * scale / 2)}" y="${f(ground)}" width="${f(front * scale)}" height="${f(depth * scale)}"/>`);
  }
  parts.push(`<circle class="body" cx="${f(cx)}" cy="${f(ground - r * scale)}" r="${f(r * scale)}"/><path class="axis" d="M${f(cx)} ${f(ground - 2 * r * scale - 6)}V${f(ground + depth * scale)}"/>`);
  const wide = Math.max(1.5, it.width * scale);
  parts.push(`<path class="touch" d="M${f(cx - wide / 2)} ${f(ground)}h${f(wide)}"/>`);
  if (it.critical) {
    const [x, y, z] = it.critical.at;
    const level = ground + (it.critical.body === "block" ? z : -z) * scale;
    parts.push(`<path class="star" d="${star(sy(y), level)}"><title>most stressed place</title></path><path class="star" d="${star(cx + x * scale, level)}"/>`);
  }
  const label = (x, y, text, anchor = "middle") => parts.push(`<text class="dim" x="${f(x)}" y="${f(y)}" text-anchor="${anchor}">${escaped(text)}</text>`);
  label((sy(it.roller[0]) + sy(it.roller[1])) / 2, ground - 2 * r * scale - (it.arm === null ? 7 : 24), it.labels.roller);
  label(cx, ground - 2 * r * scale - 7, it.labels.radius);
  label((sy(cut[0]) + sy(cut[1])) / 2, ground + depth * scale + 15, it.labels.block);
  label(cx, ground + depth * scale + 15, it.labels.width[0]);
  label(cx, ground + depth * scale + 30, it.labels.width[1]);
  set(svg, "viewBox", `0 0 ${width} ${height}`);
  set(svg, "aria-label", `From the side: ${it.labels.roller} on ${it.labels.block}. From the end: ${it.labels.radius}, ${it.labels.width.join(" ")}.`);
  layers(svg, parts.join(""));
}
