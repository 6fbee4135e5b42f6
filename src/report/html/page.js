"use strict";
// Tables that are asked for it are sorted by the column whose head is pressed.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of head.parentNode.cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = (row) => {
        const cell = row.cells[column];
        return head.className === "n" ? Number(cell.dataset.value ?? -Infinity) : cell.textContent;
      };
      const order = (a, b) => (a < b ? -1 : a > b ? 1 : 0) * (down ? -1 : 1);
      body.append(...[...body.rows].sort((a, b) => order(key(a), key(b))));
    });
  });
}
// A link leads to what may be folded.
const unfold = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const folded = target && target.closest("details:not([open])");
  if (folded) { folded.open = true; target.scrollIntoView(); }
};
addEventListener("hashchange", unfold);
unfold();
// The checks are printed, folded or not.
const opened = [];
addEventListener("beforeprint", () => {
  for (const folded of document.querySelectorAll(".failures details:not([open]), .passing:not([open])")) { folded.open = true; opened.push(folded); }
});
addEventListener("afterprint", () => { for (const folded of opened.splice(0)) folded.open = false; });

// The map.
(async () => {
  const figure = document.getElementById("map");
  if (!figure || typeof DecompressionStream === "undefined") return;
  const given = JSON.parse(figure.dataset.map);
  const packed = Uint8Array.from(atob(given.data), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = given.items;
  let at = 0;
  const take = (length) => bytes.subarray(at, (at += length));
  const short = (length) => { const b = take(2 * length); return Array.from({ length }, (_, i) => b[2 * i] | (b[2 * i + 1] << 8)); };
  // Numbers whose bytes are in planes, from the highest.
  const planes = (shift) => {
    const parts = [take(count), take(count), take(count)];
    return Uint32Array.from({ length: count }, (_, i) => (parts[0][i] << shift) | (parts[1][i] << (shift - 8)) | (parts[2][i] << (shift - 16)));
  };
  // Corners of every item in page units, its triangle, and its middle.
  let corners, triangle, size = 0;
  if (given.cells) {
    size = given.cell;
    const [x, y] = [short(count), short(count)];
    corners = Array.from({ length: count }, (_, i) => [[x[i], y[i]], [x[i] + 1, y[i]], [x[i] + 1, y[i] + 1], [x[i], y[i] + 1]].map((p) => p.map((c) => c * size)));
    triangle = planes(16);
  } else {
    const [x, y] = [short(given.points), short(given.points)].map((list) => list.map((c) => c * given.step));
    const of = [short(count), short(count), short(count)];
    corners = Array.from({ length: count }, (_, i) => of.map((list) => [x[list[i]], y[list[i]]]));
    triangle = Uint32Array.from({ length: count }, (_, i) => i);
  }
  const middle = corners.map((all) => [0, 1].map((c) => all.reduce((sum, p) => sum + p[c], 0) / all.length));
  const body = take(count);
  const values = given.maps.map(() => new Float32Array(planes(24).buffer));

  const stage = figure.querySelector(".stage"), svg = stage.querySelector("svg");
  const choice = figure.querySelector("select"), output = figure.querySelector("output");
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d");
  canvas.setAttribute("aria-hidden", "true");
  stage.prepend(canvas);
  svg.querySelector(".cells").remove();
  const ring = document.createElementNS("http://www.w3.org/2000/svg", "path");
  ring.setAttribute("class", "chosen");
  svg.append(ring);
  for (const hidden of figure.querySelectorAll(".tools, .how, output")) hidden.hidden = false;
  Object.assign(stage, { tabIndex: 0 });
  stage.setAttribute("role", "group");
  stage.setAttribute("aria-label", "Map: the arrow keys go from triangle to triangle, plus and minus zoom");

  let shown = 0, chosen = -1, box = [0, 0, given.width, given.height];
  const level = (v, map) => {
    const part = map.log ? (v > 0 ? Math.log(v / map.from) / Math.log(map.to / map.from) : 0) : (v - map.from) / (map.to - map.from);
    return Math.max(0, Math.min(given.colours.length - 1, Math.floor(part * given.colours.length)));
  };
  const outline = (i) => "M" + corners[i].map((p) => p.map((c) => c.toFixed(2)).join(" ")).join("L") + "z";
  const draw = () => {
    const wide = stage.clientWidth, dense = devicePixelRatio || 1, scale = (wide * dense) / box[2];
    canvas.width = wide * dense;
    canvas.height = (wide * dense * box[3]) / box[2];
    svg.setAttribute("viewBox", box.join(" "));
    pen.setTransform(scale, 0, 0, scale, -box[0] * scale, -box[1] * scale);
    const paths = given.colours.map(() => new Path2D());
    for (let i = 0; i < count; i++) {
      const v = values[shown][i];
      if (!Number.isFinite(v)) continue;
      const path = paths[level(v, given.maps[shown])];
      corners[i].forEach((p, k) => (k ? path.lineTo(p[0], p[1]) : path.moveTo(p[0], p[1])));
      path.closePath();
    }
    pen.lineWidth = 0.6 / Math.max(1, given.width / box[2]);
    paths.forEach((path, l) => { pen.fillStyle = pen.strokeStyle = given.colours[l]; pen.fill(path); pen.stroke(path); });
    ring.setAttribute("d", chosen < 0 ? "" : outline(chosen));
  };
  const number = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(4))).replace("-", "−") : "–");
  const tell = (i) => {
    chosen = i;
    ring.setAttribute("d", i < 0 ? "" : outline(i));
    output.replaceChildren();
    if (i < 0) return;
    const [scale, x, y] = given.plane, [X, Y] = middle[i];
    const head = document.createElement("b");
    head.textContent = `Triangle ${triangle[i]} in ${given.bodies[body[i]] ?? "?"} at (${number((X - x) / scale)}, ${number((y - Y) / scale)})`;
    output.append(head);
    for (const kind of [...new Set(given.maps.map((map) => map.kind))]) {
      const line = document.createElement("span");
      const own = given.maps.map((map, m) => [map, values[m][i]]).filter(([map]) => map.kind === kind);
      line.textContent = `${kind}: ` + own.map(([map, v]) => `${map.title} ${number(v)}`).join(", ");
      output.append(line);
    }
  };
  const inside = (p, all) => {
    const side = all.map((a, k) => { const b = all[(k + 1) % all.length]; return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]); });
    return side.every((s) => s >= 0) || side.every((s) => s <= 0);
  };
  const point = (event) => {
    const r = stage.getBoundingClientRect();
    return [box[0] + ((event.clientX - r.left) / r.width) * box[2], box[1] + ((event.clientY - r.top) / r.height) * box[3]];
  };
  const zoom = (factor, [x, y]) => {
    const wide = factor ? Math.min(given.width, Math.max(given.width / 200, box[2] / factor)) : given.width;
    const part = wide / box[2];
    box = [x - (x - box[0]) * part, y - (y - box[1]) * part, wide, (wide * given.height) / given.width];
    for (const c of [0, 1]) box[c] = Math.max(0, Math.min([given.width, given.height][c] - box[c + 2], box[c]));
    draw();
  };
  const centre = () => (chosen < 0 ? [box[0] + box[2] / 2, box[1] + box[3] / 2] : middle[chosen]);
  // The nearest middle in the direction of an arrow.
  const next = ([dx, dy]) => {
    const from = centre();
    let best = -1, least = Infinity;
    for (let i = 0; i < count; i++) {
      const d = [middle[i][0] - from[0], middle[i][1] - from[1]];
      const along = d[0] * dx + d[1] * dy, across = Math.abs(d[0] * dy - d[1] * dx);
      const far = along + 2 * across;
      if (i !== chosen && along > 1e-6 && across <= along && far < least) [best, least] = [i, far];
    }
    if (best >= 0) tell(best);
  };
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  stage.addEventListener("keydown", (event) => {
    const factor = { "+": 1.5, "=": 1.5, "-": 1 / 1.5, 0: 0 }[event.key];
    if (arrows[event.key]) next(arrows[event.key]);
    else if (factor !== undefined) zoom(factor, centre());
    else return;
    event.preventDefault();
  });
  let held = null;
  stage.addEventListener("pointerdown", (event) => { held = point(event); });
  addEventListener("pointerup", () => { held = null; });
  stage.addEventListener("pointermove", (event) => {
    const p = point(event);
    if (held && box[2] < given.width) {
      box = [box[0] + held[0] - p[0], box[1] + held[1] - p[1], box[2], box[3]];
      zoom(1, p);
      held = point(event);
    } else {
      tell(corners.findIndex((all) => inside(p, all)));
    }
  });
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoom(event.deltaY < 0 ? 1.25 : 0.8, point(event));
  }, { passive: false });
  for (const button of figure.querySelectorAll("[data-zoom]")) {
    button.addEventListener("click", () => zoom(Number(button.dataset.zoom), centre()));
  }
  choice.addEventListener("change", () => {
    shown = Number(choice.value);
    const map = given.maps[shown];
    for (const bar of figure.querySelectorAll(".bar")) bar.hidden = bar.dataset.kind !== map.kind;
    figure.querySelector(".what b").textContent = `${map.kind}, ${map.title}. `;
    figure.querySelector(".what span").textContent = figure.querySelector(`[data-kind="${map.kind}"]`).dataset.what;
    draw();
  });
  addEventListener("resize", draw);
  draw();
  figure.dataset.ready = "yes";
})();
