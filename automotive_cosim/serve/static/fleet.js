// The cars of a fleet, all on one map and each by itself, as they drive or have driven: of an evaluation of drives, or of a study of adoption.

import { ask, counted, h, seconds, speedInWords } from "./dom.js";
import { RoadRecord, RoadView } from "./road.js";

const POLL_MS = 1000;
const SPEEDS = [1, 4, 16, 64];
const MOST = 400;

export async function fleetPage(query, id, fleet, car) {
  let study = await ask(`/api/studies/${id}`);
  const known = () => study.fleets.map((each) => each.id);
  const words = (name) => study.fleets.find((each) => each.id === name)?.words ?? name;
  const shown = fleet ?? study.fleets.find((each) => each.running)?.id ?? known().at(-1);
  const home = `#/fleet/${id}/${encodeURIComponent(shown ?? "")}`;
  const head = [h("h1", {}, car ?? study.name), h("p", { class: "muted" }, car ? h("a", { href: home }, `${study.name}, ${words(shown)}`) : study.about)];
  if (!shown) return { title: study.name, content: [...head, h("p", { class: "card" }, "No car to show yet: the traffic is warming up, or share 0 of a study is driven.")], ready: () => setTimeout(() => location.hash.startsWith(`#/fleet/${id}`) && dispatchEvent(new Event("hashchange")), 3000) };

  const base = `/api/runs/${id}/episodes/${encodeURIComponent(shown)}`;
  const road = new RoadRecord();
  const running = () => study.fleets.find((each) => each.id === shown)?.running ?? false;
  let rows = new Map();
  const poll = async () => {
    road.add((await ask(`${base}/road?skip=${road.lines}`)).lines);
    study = await ask(`/api/studies/${id}`);
    if (!running() && rows.size < road.vehicles.size) rows = new Map((await ask(`/api/studies/${id}/cars/${encodeURIComponent(shown)}`)).cars.map((row) => [row.name, row]));
  };
  await poll();

  const choice = h("select", { "aria-label": "Fleet" }, known().map((each) => h("option", { value: each, selected: each === shown }, words(each))));
  choice.addEventListener("change", () => { location.hash = `#/fleet/${id}/${encodeURIComponent(choice.value)}`; });
  const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "The equipped cars from above" });
  const place = (name) => (road.trials[name] ? `#/run/${id}/${encodeURIComponent(road.trials[name])}` : `${home}/${encodeURIComponent(name)}`);
  const open = (name) => { location.hash = place(name); };
  const view = new RoadView(canvas, road, (found) => found && found.id !== car && open(found.id));
  Object.assign(view, { follows: null, turns: false, failed: new Set() });
  const about = h("p", { class: "about", role: "status" });
  const slider = h("input", { type: "range", min: 0, step: 0.1, "aria-label": "Seconds since the beginning" });
  const clock = h("output", { class: "clock" });
  const play = h("button", { type: "button", class: "main" }, "Play");
  const speed = h("select", { "aria-label": "Speed" }, SPEEDS.map((value) => h("option", { value, selected: value === 16 }, `${value}×`)));
  const body = h("tbody");
  const notes = h("ol", { class: "events" });
  let [at, playing, last, frame, timer, listed, gone] = [running() ? road.end : road.begin, false, 0, 0, 0, -1, false];

  const told = () => road.seconds.flatMap((second) => second.events.map((event) => ({ at_s: second.at_s, car: event.slice(0, event.indexOf(": ")), text: event.slice(event.indexOf(": ") + 2) })));
  function lists() {
    [slider.min, slider.max] = [road.begin, road.end];
    if (listed === road.lines + rows.size) return;
    listed = road.lines + rows.size;
    const every = told();
    const errors = new Map(every.filter(({ text }) => text.startsWith(study.fails)).map((note) => [note.car, note.text]));
    view.failed = new Set(errors.keys());
    notes.replaceChildren(...every.filter((note) => !car || note.car === car).slice(-MOST).map((note) => h("li", {}, h("button", { type: "button", class: note.text.startsWith(study.fails) ? "no" : "", onclick: () => jump(note.at_s) },
      h("span", { class: "time" }, seconds(note.at_s)), h("span", {}, car ? note.text : `${note.car}: ${note.text}`)))));
    const names = rows.size ? [...rows.keys()] : [...road.vehicles.values()].map((each) => each.id);
    const count = (name) => String(every.filter((note) => note.car === name && !note.text.startsWith(study.fails)).length);
    body.replaceChildren(...names.filter((name) => !car || name === car).sort((a, b) => errors.has(b) - errors.has(a)).slice(0, MOST).map((name) => {
      const row = rows.get(name);
      return h("tr", {}, h("td", {}, h("a", { href: place(name) }, name)), study.columns.map((_, index) => h("td", {}, row ? row.cells[index] : index ? "" : "drives")).flat(), h("td", {}, count(name)), h("td", { class: errors.has(name) ? "no" : "" }, row?.error || errors.get(name) || ""));
    }));
  }
  function show() {
    slider.value = at;
    clock.textContent = seconds(at);
    view.draw(at);
    const here = view.drawn.find((each) => each.id === car);
    about.textContent = car ? (here ? speedInWords(here.speed * 3.6, "km/h") : "not on the road now") : `${counted(view.drawn.length, "car")} on the road; red ones have lost the assistant`;
  }
  const jump = (to) => { at = Math.min(road.end, Math.max(road.begin, to)); show(); };
  function tick(now) {
    at += Math.min(0.25, (now - last) / 1000) * Number(speed.value);
    last = now;
    if (at >= road.end) { at = road.end; if (!running()) playing = false; }
    show();
    play.textContent = playing ? "Pause" : "Play";
    if (playing && !gone) frame = requestAnimationFrame(tick);
  }
  function run(on) {
    playing = on;
    if (on && !running() && at >= road.end) at = road.begin;
    last = performance.now();
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(tick);
  }
  async function again() {
    try { await poll(); lists(); show(); } catch (error) { about.textContent = `${error.message} Trying again.`; }
    if (!gone && study.running) timer = setTimeout(again, POLL_MS);
  }
  play.addEventListener("click", () => run(!playing));
  slider.addEventListener("input", () => jump(Number(slider.value)));
  const button = (label, action, title) => h("button", { type: "button", onclick: action, title }, label);
  const heads = ["Car", ...study.columns, "Acts", "Assistant"];
  return {
    title: car ?? study.name,
    content: [...head, car ? null : h("div", { class: "filters" }, choice),
      h("div", { class: "stage wide" }, h("figure", { class: "card map" }, canvas,
        h("div", { class: "tools" }, button("+", () => view.zoom(1.4), "Zoom in (+)"), button("−", () => view.zoom(1 / 1.4), "Zoom out (−)"), button("All roads", () => view.whole(), "All roads (0)"), car ? button("Follow the car", () => { view.camera.scale = 2; view.follow(car); }, "Follow the car") : null),
        h("figcaption", {}, about))),
      h("div", { class: "card transport" }, play, h("div", { class: "time-line" }, slider), clock, speed),
      h("h2", {}, "Cars"), h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Cars" }, h("table", {}, h("thead", {}, h("tr", {}, heads.map((name) => h("th", { scope: "col" }, name)))), body)),
      h("h2", {}, "What was done"), h("div", { class: "card" }, notes)].filter(Boolean),
    ready: () => {
      lists();
      view.whole();
      if (car) jump(road.seconds.find((second) => [...second.seen.keys()].some((number) => road.vehicles.get(number)?.id === car))?.at_s ?? at);
      if (car) view.follows = car;
      show();
      if (running()) run(true);
      if (study.running) timer = setTimeout(again, POLL_MS);
    },
    leave: () => { gone = true; clearTimeout(timer); cancelAnimationFrame(frame); view.leave(); },
  };
}
