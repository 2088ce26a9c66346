// Speed and limit, and the cabin's level, over time; a click jumps there.

import { kmhPerUnit, svg } from "./dom.js";

const [WIDE, HIGH, LEFT, BOTTOM, TOP] = [560, 200, 36, 24, 10];

function text(at, high, words, anchor) {
  const label = svg("text", { x: at, y: high, "text-anchor": anchor, class: "tick" });
  label.textContent = words;
  return label;
}

export function speedPlot(path, jump) {
  const root = svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "img", "aria-label": "Speed and limit over time" });
  if (path.length < 2) return root;
  const [from, to] = [path[0].at_s, path.at(-1).at_s];
  const unit = path.at(-1).speed_unit ?? "km/h";
  const tens = unit === "mph" ? 10 : 20;
  const most = tens * (Math.floor(Math.max(...path.map((one) => Math.max(one.speed_kmh, one.limit_kmh ?? 0))) / kmhPerUnit(unit) / tens) + 1);
  const x = (at) => LEFT + (at - from) / (to - from || 1) * (WIDE - LEFT - 8);
  const y = (kmh) => HIGH - BOTTOM - kmh / kmhPerUnit(unit) / most * (HIGH - BOTTOM - TOP);
  const step = most / tens > 5 ? 2 * tens : tens;
  for (let figure = 0; figure <= most; figure += step) {
    const high = y(figure * kmhPerUnit(unit));
    root.append(svg("line", { x1: LEFT, x2: WIDE - 8, y1: high, y2: high, class: "grid" }), text(LEFT - 6, high + 4, String(figure), "end"));
  }
  root.append(text(LEFT + 4, TOP + 12, unit, "start"));
  root.append(text(WIDE - 8, HIGH - 4, `+${Math.round(to)} s`, "end"), text(LEFT, HIGH - 4, `${from < 0 ? "−" : "+"}${Math.abs(Math.round(from))} s`, "start"));
  if (from < 0 && to > 0) root.append(svg("line", { x1: x(0), x2: x(0), y1: TOP, y2: HIGH - BOTTOM, class: "mark" }), text(x(0), HIGH - 4, "hand-over", x(0) > WIDE - 110 ? "end" : "middle"));
  let limit = "";
  path.forEach((one, index) => {
    if (one.limit_kmh === null) return;
    const next = path[index + 1] ?? one;
    limit += `M${x(one.at_s)} ${y(one.limit_kmh)}H${x(next.at_s)}`;
  });
  root.append(svg("path", { d: limit, class: "limit" }), svg("polyline", { points: path.map((one) => `${x(one.at_s)},${y(one.speed_kmh)}`).join(" "), class: "speed" }));
  return withCursor(root, x, from, to, jump);
}

// The cabin's level at each step, in dB(A), with a mark wherever something is said.
export function levelPlot(steps, jump) {
  const root = svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "img", "aria-label": "Level in the cabin over time" });
  const [from, to] = [0, Math.max(1, steps.at(-1).at_s)];
  const x = (at) => LEFT + at / to * (WIDE - LEFT - 8);
  const y = (level) => HIGH - BOTTOM - (level - 30) / 80 * (HIGH - BOTTOM - TOP);
  for (let figure = 30; figure <= 110; figure += 20) root.append(svg("line", { x1: LEFT, x2: WIDE - 8, y1: y(figure), y2: y(figure), class: "grid" }), text(LEFT - 6, y(figure) + 4, String(figure), "end"));
  root.append(text(LEFT + 4, TOP + 12, "dB(A)", "start"), text(LEFT, HIGH - 4, "+0 s", "start"), text(WIDE - 8, HIGH - 4, `+${Math.round(to)} s`, "end"));
  for (const each of steps.filter(({ uttered }) => uttered.length)) root.append(svg("line", { x1: x(each.at_s), x2: x(each.at_s), y1: TOP, y2: HIGH - BOTTOM, class: "mark" }));
  root.append(svg("polyline", { points: [...steps.map((each) => `${x(each.at_s)},${y(each.cabin_db)}`), `${x(to)},${y(steps.at(-1).cabin_db)}`].join(" "), class: "speed" }));
  return withCursor(root, x, from, to, jump);
}

function withCursor(root, x, from, to, jump) {
  const cursor = svg("line", { y1: TOP, y2: HIGH - BOTTOM, class: "cursor" });
  root.append(cursor);
  root.mark = (at) => { for (const name of ["x1", "x2"]) cursor.setAttribute(name, x(Math.min(to, Math.max(from, at)))); };
  root.addEventListener("click", (event) => {
    const box = root.getBoundingClientRect();
    jump(from + ((event.clientX - box.left) / box.width * WIDE - LEFT) / (WIDE - LEFT - 8) * (to - from));
  });
  return root;
}
