// The road on a canvas: the ground, lanes, junctions, lights and every vehicle, interpolated between the recorded seconds.

const TELEPORT_M = 50;
const GAP_M = 0.25;
const LEAST_PX = 7;
const TILE_M = 300;
const INSET = { side: 150, metres: 1100, margin: 12 };
const SIGNAL = { right: 1, left: 2, hazard: 4, brake: 8, blue: 2048 };
const HEAVY = new Set(["bus", "coach", "truck", "trailer", "delivery", "tram", "rail", "rail_urban"]);
const DAY = { land: "#d6ddd6", line: "#f0f3f6", road: "#808994", bus: "#947676", path: "#b0b6b4", car: "#2c3644", heavy: "#7a521a", edge: "#f0f3f6", green: "#b8d4b0", water: "#9ec6e2", building: "#c4cac8" };
const NIGHT = { land: "#10151c", line: "#586373", road: "#2b333f", bus: "#3e3236", path: "#202830", car: "#b0bccb", heavy: "#d6bd80", edge: "#0a0d12", green: "#13241c", water: "#112a42", building: "#1c222b" };
const GROUND = ["green", "water", "building"]; // in the order in which they are drawn
const LIGHTS = { G: "#2ecc71", g: "#2ecc71", y: "#ffb42e", Y: "#ffb42e", r: "#e5484d", u: "#e5484d" };

// What was recorded, second by second.
export class RoadRecord {
  constructor() {
    this.lines = 0;
    this.laneCount = 0;
    this.vehicles = new Map();
    this.seconds = [];
    this.alone = false;
    this.trials = {};
    this.baseline = [];
    this.bands = new Map();
    this.areas = new Path2D();
    this.ground = Object.fromEntries(GROUND.map((kind) => [kind, []]));
    this.stops = [];
    this.bounds = [Infinity, Infinity, -Infinity, -Infinity];
  }

  add(lines) {
    this.lines += lines.length;
    for (const line of lines) {
      if (line.alone) this.alone = true;
      if (line.cars) this.trials = line.cars;
      if (line.baseline) this.baseline = line.baseline;
      for (const lane of line.lanes ?? []) this.addLane(lane);
      for (const outline of line.junctions ?? []) {
        this.areas.moveTo(outline[0], outline[1]);
        for (let i = 2; i < outline.length; i += 2) this.areas.lineTo(outline[i], outline[i + 1]);
        this.areas.closePath();
      }
      for (const [kind, outline] of line.ground ?? []) this.ground[kind]?.push(area(outline));
      for (const [number, id, kind, length, width] of line.vehicles ?? []) this.vehicles.set(number, { id, kind, length, width });
      if ("at_s" in line) {
        const before = this.seconds.at(-1);
        const seen = new Map(line.seen.map(([number, ...rest]) => [number, rest]));
        this.seconds.push({ ...line, seen, lights: { ...before?.lights, ...line.lights } });
      }
    }
  }

  // Lanes of a kind and a place share one path, which is drawn only if its box is in sight.
  addLane([kind, width, line, links]) {
    this.laneCount += 1;
    const key = `${kind} ${width} ${Math.floor(line[0] / TILE_M)} ${Math.floor(line[1] / TILE_M)}`;
    if (!this.bands.has(key)) this.bands.set(key, { kind, width, path: new Path2D(), bounds: [Infinity, Infinity, -Infinity, -Infinity] });
    const band = this.bands.get(key);
    band.path.moveTo(line[0], line[1]);
    for (let i = 0; i < line.length; i += 2) {
      if (i) band.path.lineTo(line[i], line[i + 1]);
      for (const bounds of [this.bounds, band.bounds]) {
        bounds[0] = Math.min(bounds[0], line[i]);
        bounds[1] = Math.min(bounds[1], line[i + 1]);
        bounds[2] = Math.max(bounds[2], line[i]);
        bounds[3] = Math.max(bounds[3], line[i + 1]);
      }
    }
    if (links.length && line.length >= 4) {
      const [x0, y0, x1, y1] = line.slice(-4);
      const long = Math.hypot(x1 - x0, y1 - y0) || 1;
      const [across, up] = [-(y1 - y0) / long * (width / 2 - GAP_M), (x1 - x0) / long * (width / 2 - GAP_M)];
      this.stops.push({ links, from: [x1 - across, y1 - up], to: [x1 + across, y1 + up] });
    }
  }

  get begin() { return this.seconds[0]?.at_s ?? 0; }
  get end() { return this.seconds.at(-1)?.at_s ?? 0; }

  // The last recorded second up to an instant.
  index(at) {
    let [low, high] = [0, this.seconds.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.seconds[middle].at_s <= at + 1e-6) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  second(at) { return this.seconds[this.index(at)]; }

  // The car in the baseline run at an instant, if it is not where the car itself is.
  ghost(at, ego) {
    const index = this.baseline.findLastIndex(([at_s]) => at_s <= at + 1e-6);
    const [now, next] = [this.baseline[index], this.baseline[index + 1]];
    if (!now || (!next && at > now[0] + 0.5)) return null;
    const found = next ? between(now.slice(1), next.slice(1), Math.min(1, (at - now[0]) / (next[0] - now[0])), next[0] - now[0]) : state(now.slice(1));
    return ego && Math.hypot(found.x - ego.x, found.y - ego.y) < 1 ? null : found;
  }

  // Every vehicle at an instant: as recorded on a recorded second, on a smooth line in between.
  at(at) {
    const index = this.index(at);
    const [now, next] = [this.seconds[index], this.seconds[index + 1]];
    if (!now) return [];
    const gap = next ? next.at_s - now.at_s : 1;
    const share = next ? Math.min(1, Math.max(0, (at - now.at_s) / gap)) : 0;
    const found = [];
    for (const [number, here] of now.seen) {
      const there = next?.seen.get(number);
      found.push({ number, ...this.vehicles.get(number), ...(there && share ? between(here, there, share, gap) : state(here)) });
    }
    return found;
  }
}

// An outline as a path with its box.
function area(outline) {
  const path = new Path2D();
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < outline.length; i += 2) {
    const [x, y] = [outline[i], outline[i + 1]];
    path.lineTo(x, y);
    [bounds[0], bounds[1], bounds[2], bounds[3]] = [Math.min(bounds[0], x), Math.min(bounds[1], y), Math.max(bounds[2], x), Math.max(bounds[3], y)];
  }
  return { path, bounds };
}

const overlap = (a, b) => a[0] < b[2] && a[2] > b[0] && a[1] < b[3] && a[3] > b[1];

const state = ([x, y, heading, speed, signals]) => ({ x, y, heading, speed, signals });

function between(here, there, share, gap) {
  const [a, b] = [state(here), state(there)];
  if (Math.hypot(b.x - a.x, b.y - a.y) > TELEPORT_M) return share < 0.5 ? a : b;
  const turn = ((b.heading - a.heading + 540) % 360) - 180;
  const [s, t] = [share, 1 - share];
  // a cubic whose ends have the recorded speeds and headings
  const curve = (from, to, pull, push) => t * t * (1 + 2 * s) * from + s * s * (3 - 2 * s) * to + s * t * t * pull * gap - s * s * t * push * gap;
  const along = ({ heading, speed }) => [Math.sin(heading * Math.PI / 180) * speed, Math.cos(heading * Math.PI / 180) * speed];
  const [va, vb] = [along(a), along(b)];
  return { x: curve(a.x, b.x, va[0], vb[0]), y: curve(a.y, b.y, va[1], vb[1]), heading: a.heading + share * turn, speed: a.speed + share * (b.speed - a.speed), signals: a.signals };
}

export class RoadView {
  constructor(canvas, record, picked) {
    this.canvas = canvas;
    this.record = record;
    this.picked = picked;
    this.camera = { x: 0, y: 0, scale: 3.2, heading: 0 };
    this.follows = "ego";
    this.turns = true;
    this.at = 0;
    this.drawn = [];
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.release(event));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), event.offsetX, event.offsetY);
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    this.size = new ResizeObserver(() => this.draw(this.at));
    this.size.observe(canvas);
  }

  leave() { this.size.disconnect(); }

  // --- camera ---

  zoom(factor, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    const before = this.metres(x, y);
    this.camera.scale = Math.min(40, Math.max(0.05, this.camera.scale * factor));
    if (!this.follows) {
      const after = this.metres(x, y);
      this.camera.x += before[0] - after[0];
      this.camera.y += before[1] - after[1];
    }
    this.draw(this.at);
  }

  pan(dx, dy) {
    this.follow(null);
    const [from, to] = [this.metres(0, 0), this.metres(dx, dy)];
    this.camera.x -= to[0] - from[0];
    this.camera.y -= to[1] - from[1];
    this.draw(this.at);
  }

  follow(id) {
    this.follows = id;
    this.changed?.();
    this.draw(this.at);
  }

  turn(on) {
    this.turns = on;
    if (!on) this.camera.heading = 0;
    this.changed?.();
    this.draw(this.at);
  }

  whole() {
    const [left, bottom, right, top] = this.record.bounds;
    if (!(right > left || top > bottom)) return;
    this.follows = null;
    this.turns = false;
    this.camera = { x: (left + right) / 2, y: (bottom + top) / 2, heading: 0, scale: 0.94 * Math.min(this.canvas.clientWidth / (right - left || 1), this.canvas.clientHeight / (top - bottom || 1)) };
    this.changed?.();
    this.draw(this.at);
  }

  get down() { return this.follows && this.turns ? 0.66 : 0.5; }

  metres(px, py) {
    const { x, y, scale, heading } = this.camera;
    const angle = heading * Math.PI / 180;
    const [right, up] = [(px - this.canvas.clientWidth / 2) / scale, (this.canvas.clientHeight * this.down - py) / scale];
    return [x + right * Math.cos(angle) + up * Math.sin(angle), y - right * Math.sin(angle) + up * Math.cos(angle)];
  }

  pixels(x, y) {
    const { scale, heading } = this.camera;
    const angle = heading * Math.PI / 180;
    const [dx, dy] = [x - this.camera.x, y - this.camera.y];
    return [this.canvas.clientWidth / 2 + scale * (dx * Math.cos(angle) - dy * Math.sin(angle)), this.canvas.clientHeight * this.down - scale * (dx * Math.sin(angle) + dy * Math.cos(angle))];
  }

  // --- input ---

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.moved = 0;
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.offsetX, event.offsetY];
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, now);
    if (others.length) {
      const [, other] = others[0];
      const reach = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
      this.moved = 99;
      this.zoom(reach(now) / reach(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      return;
    }
    this.moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
    if (this.moved > 5) this.pan(now[0] - before[0], now[1] - before[1]);
  }

  release(event) {
    if (this.pointers.delete(event.pointerId) && event.type === "pointerup" && this.moved <= 5) this.pick(event.offsetX, event.offsetY);
  }

  pick(px, py) {
    let [best, reach] = [null, 24];
    for (const vehicle of this.drawn) {
      const angle = vehicle.heading * Math.PI / 180;
      const [x, y] = this.pixels(vehicle.x - Math.sin(angle) * vehicle.length / 2, vehicle.y - Math.cos(angle) * vehicle.length / 2);
      const away = Math.hypot(x - px, y - py);
      if (away < reach) [best, reach] = [vehicle, away];
    }
    this.picked(best);
  }

  key(event) {
    const step = 60;
    const keys = {
      ArrowLeft: () => this.pan(step, 0), ArrowRight: () => this.pan(-step, 0), ArrowUp: () => this.pan(0, step), ArrowDown: () => this.pan(0, -step),
      "+": () => this.zoom(1.3), "=": () => this.zoom(1.3), "-": () => this.zoom(1 / 1.3), f: () => this.follow("ego"), h: () => this.turn(!this.turns), 0: () => this.whole(),
    };
    const done = keys[event.key];
    if (!done || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    done();
  }

  // --- drawing ---

  draw(at) {
    this.at = at;
    const { canvas, camera, record } = this;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const second = record.second(at);
    this.drawn = record.at(at);
    const followed = this.drawn.find(({ id }) => id === this.follows);
    if (followed) {
      [camera.x, camera.y] = [followed.x, followed.y];
      if (this.turns) camera.heading = followed.heading;
    }
    const colours = second?.sun_deg === null || second?.sun_deg === undefined || second.sun_deg > -0.833 ? DAY : NIGHT;
    const context = canvas.getContext("2d", { alpha: false });
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = colours.land;
    context.fillRect(0, 0, width, height);
    const angle = camera.heading * Math.PI / 180;
    const scale = camera.scale * ratio;
    const [cos, sin] = [Math.cos(angle) * scale, Math.sin(angle) * scale];
    const [left, down] = [width / 2, height * this.down];
    // metres, y to the north, to pixels
    context.setTransform(cos, -sin, -sin, -cos, left - camera.x * cos + camera.y * sin, down + camera.x * sin + camera.y * cos);
    this.pixel = 1 / camera.scale;
    const corners = [[0, 0], [canvas.clientWidth, 0], [0, canvas.clientHeight], [canvas.clientWidth, canvas.clientHeight]].map((corner) => this.metres(...corner));
    const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
    this.sight = [Math.min(...xs) - 20, Math.min(...ys) - 20, Math.max(...xs) + 20, Math.max(...ys) + 20];
    context.lineJoin = "round";
    this.ground(context, colours, second);
    for (const [kind, x, y] of second?.incidents ?? []) this.incident(context, kind, x, y);
    for (const vehicle of this.drawn) if (vehicle.id !== "ego" && this.sees(vehicle.x, vehicle.y)) this.vehicle(context, vehicle, colours);
    const ego = this.drawn.find(({ id }) => id === "ego");
    this.ghost = record.ghost(at, ego);
    if (this.ghost) this.shadow(context, { ...this.ghost, length: ego?.length ?? 4.5, width: ego?.width ?? 1.8 });
    if (ego) this.vehicle(context, ego, colours);
    if (camera.scale > 1 && width > 2.6 * INSET.side * ratio) this.inset(context, colours, ratio);
  }

  sees(x, y) {
    const [left, bottom, right, top] = this.sight;
    return x > left && x < right && y > bottom && y < top;
  }

  // The surrounding streets with a dot for each vehicle, turned the same way.
  inset(context, colours, ratio) {
    const { canvas, camera } = this;
    const [side, margin] = [INSET.side * ratio, INSET.margin * ratio];
    const [left, top] = [canvas.width - side - margin, canvas.height - side - margin];
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.beginPath();
    context.roundRect(left, top, side, side, 12 * ratio);
    context.fillStyle = colours.land;
    context.fill();
    context.strokeStyle = colours.car;
    context.lineWidth = 1.5 * ratio;
    context.stroke();
    context.clip();
    const scale = side / INSET.metres;
    const angle = camera.heading * Math.PI / 180;
    const [cos, sin] = [Math.cos(angle) * scale, Math.sin(angle) * scale];
    const [x, y] = [left + side / 2, top + side / 2];
    context.setTransform(cos, -sin, -sin, -cos, x - camera.x * cos + camera.y * sin, y + camera.x * sin + camera.y * cos);
    const map = this.surroundings(colours, scale);
    // the bitmap's rows go south, metres go north
    context.save();
    context.translate(map.x, map.y);
    context.scale(1, -1);
    context.drawImage(map.bitmap, -map.metres / 2, -map.metres / 2, map.metres, map.metres);
    context.restore();
    for (const vehicle of [...this.drawn].sort((a) => (a.id === "ego" ? 1 : -1))) {
      const isEgo = vehicle.id === "ego";
      const r = (isEgo ? 5 : 2.6) * ratio / scale;
      context.fillStyle = isEgo ? "#1f78e6" : colours.car;
      context.strokeStyle = "#fff";
      context.lineWidth = (isEgo ? 2 : 0) * ratio / scale;
      context.beginPath();
      context.arc(vehicle.x, vehicle.y, r, 0, 2 * Math.PI);
      context.fill();
      if (isEgo) context.stroke();
    }
    context.restore();
  }

  // A picture of the surrounding roads, north up, kept until the camera has left its middle.
  surroundings(colours, scale) {
    const metres = 2 * INSET.metres;
    const { x, y } = this.camera;
    const kept = this.map;
    if (kept && kept.colours === colours && kept.scale === scale && kept.lines === this.record.laneCount && Math.hypot(kept.x - x, kept.y - y) < INSET.metres / 4) return kept;
    const bitmap = new OffscreenCanvas(Math.ceil(metres * scale * 2), Math.ceil(metres * scale * 2));
    const context = bitmap.getContext("2d");
    const fine = bitmap.width / metres;
    context.setTransform(fine, 0, 0, -fine, bitmap.width / 2 - x * fine, bitmap.height / 2 + y * fine);
    this.land(context, colours, [x - metres / 2, y - metres / 2, x + metres / 2, y + metres / 2]);
    context.strokeStyle = colours.road;
    context.lineWidth = 9;
    for (const { path } of this.record.bands.values()) context.stroke(path);
    this.map = { bitmap, metres, x, y, colours, scale, lines: this.record.laneCount };
    return this.map;
  }

  // Green, water and buildings within a box.
  land(context, colours, box) {
    for (const kind of GROUND) {
      context.fillStyle = colours[kind];
      for (const { path, bounds } of this.record.ground[kind]) if (overlap(bounds, box)) context.fill(path);
    }
  }

  ground(context, colours, second) {
    this.land(context, colours, this.sight);
    const bands = [...this.record.bands.values()].filter(({ bounds }) => overlap(bounds, this.sight));
    context.strokeStyle = colours.line;
    if (this.pixel < 1) {
      for (const { width, path } of bands) {
        context.lineWidth = width + GAP_M;
        context.stroke(path);
      }
    }
    context.fillStyle = colours.road;
    context.fill(this.record.areas);
    for (const { kind, width, path } of bands) {
      context.strokeStyle = { road: colours.road, bus: colours.bus }[kind] ?? colours.path;
      context.lineWidth = Math.max(width - GAP_M, 1.2 * this.pixel);
      context.stroke(path);
    }
    if (!second || this.pixel > 1.2) return;
    context.lineWidth = Math.max(0.7, 2 * this.pixel);
    const lines = new Map();
    for (const { links, from, to } of this.record.stops) {
      if (!this.sees(...from)) continue;
      const letters = links.map(([light, place]) => second.lights[light]?.[place]).filter(Boolean);
      if (!letters.length) continue;
      const colour = LIGHTS[[..."GgyYru"].find((letter) => letters.includes(letter))] ?? colours.line;
      if (!lines.has(colour)) lines.set(colour, new Path2D());
      lines.get(colour).moveTo(...from);
      lines.get(colour).lineTo(...to);
    }
    for (const [colour, path] of lines) {
      context.strokeStyle = colour;
      context.stroke(path);
    }
  }

  incident(context, kind, x, y) {
    const size = Math.max(3, 11 * this.pixel);
    context.fillStyle = "#ffb42e";
    context.strokeStyle = "#1e1400";
    context.lineWidth = 1.5 * this.pixel;
    context.beginPath();
    context.arc(x, y, size, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    context.beginPath();
    context.lineWidth = 2.5 * this.pixel;
    context.moveTo(x, y + 0.5 * size);
    context.lineTo(x, y - 0.1 * size);
    context.moveTo(x, y - 0.45 * size);
    context.lineTo(x, y - 0.5 * size);
    context.stroke();
  }

  // The outline of the car in the baseline run.
  shadow(context, { x, y, heading, length, width }) {
    const angle = heading * Math.PI / 180;
    const [east, north] = [Math.sin(angle), Math.cos(angle)];
    const long = Math.max(length, 1.7 * LEAST_PX * this.pixel);
    const wide = Math.max(width, 0.8 * LEAST_PX * this.pixel) / 2;
    context.beginPath();
    for (const [ahead, right] of [[0, -1], [0, 1], [-1, 1], [-1, -1]]) context.lineTo(x + ahead * long * east + right * wide * north, y + ahead * long * north - right * wide * east);
    context.closePath();
    context.strokeStyle = "#fff";
    context.lineWidth = 4 * this.pixel;
    context.stroke();
    context.strokeStyle = "#1f78e6";
    context.lineWidth = 2.4 * this.pixel;
    context.setLineDash([5 * this.pixel, 3 * this.pixel]);
    context.stroke();
    context.setLineDash([]);
  }

  vehicle(context, vehicle, colours) {
    const isEgo = vehicle.id === "ego";
    const least = (isEgo || this.failed ? 1.7 : 1) * LEAST_PX * this.pixel;
    const [long, wide] = [Math.max(vehicle.length, least), Math.max(vehicle.width, least * 0.45)];
    const angle = vehicle.heading * Math.PI / 180;
    const [east, north] = [Math.sin(angle), Math.cos(angle)];
    // 0 to -1 from the front bumper to the rear, -1 to 1 from left to right
    const point = (ahead, right, margin = 0) => {
      const forth = ahead * (long + 2 * margin) + margin;
      const across = right * (wide / 2 + margin);
      return [vehicle.x + forth * east + across * north, vehicle.y + forth * north - across * east];
    };
    const outline = (margin) => {
      context.beginPath();
      for (const [ahead, right] of [[0, -0.5], [0, 0.5], [-0.16, 1], [-1, 1], [-1, -1], [-0.16, -1]]) context.lineTo(...point(ahead, right, margin));
      context.closePath();
      context.fill();
    };
    context.fillStyle = isEgo ? "#fff" : this.follows === vehicle.id ? "#ffb42e" : colours.edge;
    outline((isEgo || this.follows === vehicle.id ? 2 : 1) * this.pixel);
    context.fillStyle = this.failed?.has(vehicle.id) ? "#e5484d" : isEgo || this.failed ? "#1f78e6" : HEAVY.has(vehicle.kind) ? colours.heavy : colours.car;
    if (vehicle.kind === "emergency") context.fillStyle = vehicle.signals & SIGNAL.blue ? "#3c78ff" : "#ebebf0";
    outline(0);
    if (this.pixel > 0.5) return;
    const lamps = (places, colour) => {
      context.fillStyle = colour;
      for (const place of places) {
        context.beginPath();
        context.arc(...point(...place), Math.max(0.3, 1.3 * this.pixel), 0, 2 * Math.PI);
        context.fill();
      }
    };
    if (vehicle.signals & SIGNAL.brake) lamps([[-1, -0.62], [-1, 0.62]], "#ff2830");
    if (vehicle.signals & (SIGNAL.left | SIGNAL.hazard)) lamps([[-0.94, -0.9], [-0.06, -0.9]], "#ffaa1e");
    if (vehicle.signals & (SIGNAL.right | SIGNAL.hazard)) lamps([[-0.94, 0.9], [-0.06, 0.9]], "#ffaa1e");
  }
}

export function signals(bits) {
  const names = { hazard: "hazard lights", left: "indicates left", right: "indicates right", brake: "brakes", blue: "blue lights" };
  return Object.entries(names).filter(([name]) => bits & SIGNAL[name]).map(([, words]) => words).join(", ");
}
