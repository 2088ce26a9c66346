// One recorded episode, or one that is running: screen, road, steps and verdict on one time cursor.

import { ask, counted, h, modelName, outcome, plain, seconds, speedInWords } from "./dom.js";
import { RoadRecord, RoadView, signals } from "./road.js";
import { levelPlot, speedPlot } from "./plot.js";

const POLL_MS = 1000;
const WEATHER = [[0, "clear"], [3, "cloudy"], [48, "fog"], [57, "drizzle"], [67, "rain"], [77, "snow"], [82, "showers"], [86, "snow showers"], [99, "thunderstorm"]]; // up to each WMO code
const SPEEDS = [0.25, 0.5, 1, 2, 4, 8, 16, 32];

export async function replayPage(query, id, episode) {
  const base = `/api/runs/${id}${episode ? `/episodes/${encodeURIComponent(episode)}` : ""}`;
  let run = await ask(base);
  const road = new RoadRecord();
  const steps = [];
  const poll = async () => {
    const [more, lines] = await Promise.all([ask(`${base}/steps?skip=${steps.length}`), ask(`${base}/road?skip=${road.lines}`)]);
    steps.push(...more.steps);
    road.add(lines.lines);
    return more.running;
  };
  let running = await poll();

  const screen = h("img", { class: "screen", alt: "", onload: () => {
    const ratio = screen.naturalWidth / screen.naturalHeight;
    Object.assign(box.style, { aspectRatio: `${ratio}`, maxWidth: ratio < 1 ? `${80 * ratio}vh` : "" });
  } });
  const target = h("div", { class: "target", hidden: true });
  const noScreen = h("p", { class: "muted empty" }, "No picture of this screen was kept.");
  const ahead = h("img", { class: "ahead", alt: "", hidden: true, width: 640, height: 360 });
  const box = h("div", { class: "frame" }, screen, target, noScreen);
  const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "The road from above" });
  const about = h("p", { class: "about" });
  const slider = h("input", { type: "range", min: 0, max: 0, step: 0.1, value: 0, "aria-label": "Time in the drive" });
  const marks = h("div", { class: "marks", "aria-hidden": "true" });
  const clock = h("output", { class: "clock" });
  const play = h("button", { type: "button", class: "main" }, "Play");
  const speed = h("select", { "aria-label": "Speed of the replay" }, SPEEDS.map((value) => h("option", { value, selected: value === (SPEEDS.find((each) => each === Number(query.get("speed"))) ?? 1) }, `${value}×`)));
  const live = h("button", { type: "button", "aria-pressed": "true", hidden: true }, "Follow live");
  const list = h("ol", { class: "steps" });
  const events = h("ol", { class: "events" });
  const detail = h("div", { class: "card" });
  const vehicle = h("div", { class: "card vehicle", hidden: true });
  const verdict = h("section", {});
  const plot = h("div", { class: "card" });
  const level = h("div", {});
  const heading = h("div", { class: "head" });
  const note = h("p", { class: "warning", hidden: true, role: "status" });

  let at = 0;
  let playing = false;
  let following = running && !query.has("at") && !query.has("speed");
  let picked = null;
  let shownStep = null;
  let last = 0;
  let frame = 0;
  let timer = 0;
  let saved = 0;

  const view = new RoadView(canvas, road, (found) => { picked = found?.id ?? null; show(); });

  const begin = () => Math.min(road.seconds.length ? road.begin : 0, 0);
  const end = () => Math.max(road.end, steps.at(-1)?.at_s ?? 0);
  const step = () => steps.findLastIndex((each) => each.at_s <= at + 1e-6);

  function head() {
    const told = [run.of_study && h("a", { href: `#/decisions/${id}` }, run.name), run.half && `${run.half} half`, run.scenario, run.agent, run.model !== "none" && modelName(run.model), run.seed !== null && `seed ${run.seed}`];
    heading.replaceChildren(
      h("div", {}, h("h1", {}, run.task), run.goal && h("p", { class: "said" }, `“${run.goal}”`), h("p", { class: "muted" }, told.filter(Boolean).flatMap((each, index) => (index ? [" · ", each] : [each])))),
      run.of_study ? h("span", { class: running ? "pill live" : "pill quiet" }, running ? "Running" : "Ended")
        : run.kind === "drive" && !running ? h("span", { class: run.value === null ? "pill" : "pill quiet" }, run.value === null ? plain(run.end) || "No judgement" : `Score ${Math.round(run.value)} · ${run.met} of ${run.spans.filter((each) => !each.lookalike && each.outcome !== "void").length} events met`) : outcome({ ...run, running }));
    live.hidden = !running;
    const parts = Object.entries(run.verdict?.parts ?? {});
    verdict.replaceChildren(...(parts.length ? [h("h2", {}, "Verdict"), h("ol", { class: "card parts" },
      parts.map(([name, part]) => h("li", {}, h("b", { class: part.ok ? "yes" : "no" }, `${part.ok ? "✓" : "✗"} ${run.parts[name] ?? plain(name)}`), h("span", {}, part.why)))),
      h("p", { class: "muted" }, `Basis: ${run.verdict.basis}${run.verdict.rule ? `, ${run.verdict.rule}` : ""}`)] : []),
      ...(run.error || run.agent_error ? [h("h2", {}, run.error ? "Error" : "The agent failed"), h("p", { class: "warning" }, run.error || run.agent_error)] : []));
  }

  function lists() {
    list.replaceChildren(...steps.map((each, index) => h("li", {}, h("button", { type: "button", onclick: () => jump(each.at_s), "data-step": index },
      h("span", { class: "time" }, seconds(each.at_s)), h("span", {}, `${each.number && !run.of_study ? `${each.number}  ` : ""}${each.words}`)))));
    const told = run.timeline.length ? run.timeline : road.seconds.flatMap((second) => second.events.map((text) => ({ at_s: second.at_s, kind: "road", text })));
    events.replaceChildren(...told.map((event) => h("li", {}, h("button", { type: "button", class: `k-${event.kind}`, onclick: () => jump(event.at_s) },
      h("span", { class: "time" }, seconds(event.at_s)), h("span", {}, event.text)))));
    [slider.min, slider.max] = [begin(), end()];
    const span = end() - begin() || 1;
    marks.replaceChildren(...told.filter(({ kind }) => !["departure", "event", "deadline"].includes(kind)).map((event) => {
      const mark = h("i", { class: `k-${event.kind}` });
      mark.style.left = `${100 * (event.at_s - begin()) / span}%`;
      return mark;
    }));
    marks.append(...(run.spans ?? []).filter((each) => each.outcome !== "void").map((each) => {
      const bar = h("i", { class: `span ${each.lookalike ? "lookalike" : ["hit", "prepared", "prevented"].includes(each.outcome) ? "good" : "bad"}`, title: `${each.kind}: ${each.words} [${each.became}]` });
      bar.style.left = `${100 * (each.from_s - begin()) / span}%`;
      bar.style.width = `max(3px, ${100 * (each.to_s - each.from_s) / span}%)`;
      return bar;
    }));
    const path = run.path.length ? run.path : road.seconds;
    plot.replaceChildren(speedPlot(path, jump));
    plot.hidden = path.length < 2;
    const levels = steps.filter((each) => each.cabin_db !== undefined);
    level.replaceChildren(...(levels.length ? [h("h2", {}, "Level in the cabin"), h("div", { class: "card" }, levelPlot(levels, jump))] : []));
    shownStep = null;
  }

  function show() {
    slider.value = at;
    slider.setAttribute("aria-valuetext", `${seconds(at)} from the ${run.kind === "drive" ? "departure" : "hand-over"}`);
    clock.textContent = seconds(at);
    view.draw(at);
    const second = road.second(at);
    if (second) {
      const others = second.seen.size - ([...second.seen.keys()].some((number) => road.vehicles.get(number)?.id === "ego") ? 1 : 0);
      const limit = second.limit_kmh === null ? "no limit known" : `limit ${speedInWords(second.limit_kmh, second.speed_unit).split(" ")[0]}`;
      about.replaceChildren(h("b", { class: second.limit_kmh !== null && second.speed_kmh > second.limit_kmh + 1 ? "over" : "" }, speedInWords(second.speed_kmh, second.speed_unit)),
        ` ${limit} · ${second.road || "an unnamed road"}${second.local_time ? ` · ${second.local_time.slice(11, 16)}` : ""}${sky(second)} · `,
        road.alone ? "other vehicles were not recorded" : `${counted(others, "other vehicle")} in sight`,
        view.ghost ? h("span", { class: "ghost" }, "Dashed: the same drive with nobody at the cockpit") : "");
      canvas.setAttribute("aria-label", `The road from above. ${about.textContent}`);
    }
    plot.firstElementChild?.mark?.(at);
    level.querySelector("svg")?.mark(at);
    showVehicle();
    const index = step();
    if (index !== shownStep) showStep(index);
  }

  function sky({ weather_code: code, sun_deg: sun }) {
    if (code === null || code === undefined) return "";
    return `, ${WEATHER.find(([most]) => code <= most)?.[1] ?? "weather unknown"}${sun !== null && sun <= -0.833 ? ", dark" : ""}`;
  }

  function showVehicle() {
    const found = picked && view.drawn.find(({ id }) => id === picked);
    vehicle.hidden = !found;
    if (!found) return;
    vehicle.replaceChildren(h("b", {}, found.id === "ego" ? "The car under test" : found.id),
      h("span", { class: "muted" }, [plain(found.kind), `${found.length} m long`, speedInWords(found.speed * 3.6, road.second(at)?.speed_unit), signals(found.signals)].filter(Boolean).join(" · ")),
      h("button", { type: "button", onclick: () => view.follow(found.id) }, "Follow"));
  }

  function showStep(index) {
    shownStep = index;
    for (const button of list.querySelectorAll("button")) {
      if (Number(button.dataset.step) === index) {
        button.setAttribute("aria-current", "step");
        list.scrollTop = button.offsetTop - list.clientHeight / 2;
      } else button.removeAttribute("aria-current");
    }
    const now = steps[index];
    const pictured = now?.has_picture ? now : null;
    screen.hidden = !pictured;
    noScreen.hidden = Boolean(pictured);
    noScreen.textContent = index < 0 ? "Before the hand-over: no agent acts yet." : "No picture of this screen was kept.";
    if (pictured) {
      screen.src = `${base}/pictures/${pictured.picture}`;
      screen.alt = `The cockpit's screen after step ${pictured.number}: ${pictured.words}`;
    }
    ahead.hidden = !now?.has_view;
    if (!ahead.hidden) {
      ahead.src = `${base}/views/${now.number}`;
      ahead.alt = `The road ahead after step ${now.number}`;
    }
    const next = steps[index + 1];
    target.hidden = !(pictured && next?.target);
    if (!target.hidden) {
      const [left, top, right, bottom] = next.target;
      const [wide, high] = (run.screen ?? "1280x720").split("x").map(Number);
      const share = (part, whole) => `${100 * part / whole}%`;
      Object.assign(target.style, { left: share(left, wide), top: share(top, high), width: share(right - left, wide), height: share(bottom - top, high) });
    }
    detail.replaceChildren(...(now ? told(now) : [h("h3", {}, "The drive up to the hand-over"), h("p", { class: "muted" }, "No agent acts yet.")]));
  }

  function told(now) {
    return [
      h("h3", {}, now.number ? `${run.of_study ? "" : `Step ${now.number}: `}${now.words}` : run.kind === "drive" ? "Departure" : "Hand-over"),
      now.thought && h("p", { class: "thought" }, now.thought),
      now.uttered.map((each, index) => uttered(each, `${base}/sounds/${now.number}/${index}`)),
      now.feedback.text && h("p", { class: "muted" }, `${plain(now.feedback.code)}: ${now.feedback.text}`),
      now.action && h("p", {}, h("code", {}, JSON.stringify(now.action))),
      now.stages.map((stage) => h("details", { open: stage.text.length < 600 },
        h("summary", {}, plain(stage.name), stage.tokens_in ? ` · ${stage.tokens_in} + ${stage.tokens_out} tokens${stage.seconds ? `, ${stage.seconds.toFixed(1)} s` : ""}` : ""), h("pre", {}, stage.text))),
      now.context && h("details", {}, h("summary", {}, "geo-context"), h("pre", {}, now.context)),
    ].flat().filter(Boolean);
  }

  function uttered(each, address) {
    return h("div", { class: "uttered" }, h("p", {}, h("b", {}, `“${each.said}”`), ` reaches the agent as “${each.heard}”, in ${Math.round(each.noise_db)} dB(A)`),
      each.can_sound ? h("audio", { controls: true, preload: "none", src: address, "aria-label": "What was said, in the cabin" }) : h("p", { class: "muted" }, "The extra `voice` makes it sound here."));
  }

  function jump(to, keep = false) {
    if (!keep) following = false;
    live.setAttribute("aria-pressed", String(following));
    at = Math.min(end(), Math.max(begin(), to));
    show();
    clearTimeout(saved);
    if (!keep) saved = setTimeout(() => history.replaceState(null, "", link()), 150);
  }

  const link = () => `#/run/${id}${episode ? `/${encodeURIComponent(episode)}` : ""}?at=${Math.round(at * 10) / 10}`;

  function run_(on) {
    playing = on;
    play.textContent = on ? "Pause" : "Play";
    if (on && at >= end() - 0.05 && !running) at = begin();
    last = performance.now();
    cancelAnimationFrame(frame);
    if (on) frame = requestAnimationFrame(tick);
    else jump(at, following);
  }

  function tick(now) {
    const passed = Math.min(0.25, (now - last) / 1000);
    last = now;
    at += passed * Number(speed.value);
    if (following) at += (end() - 1 - at) * Math.min(1, passed * 2);
    if (at >= end()) {
      at = end();
      if (!running) { show(); run_(false); return; }
    }
    show();
    frame = requestAnimationFrame(tick);
  }

  const hop = (by) => {
    const index = Math.max(0, Math.min(steps.length - 1, by > 0 ? step() + 1 : steps.findLastIndex((each) => each.at_s < at - 0.05)));
    if (steps[index]) jump(steps[index].at_s);
  };

  const button = (label, action, title) => h("button", { type: "button", onclick: action, title }, label);
  const turn = h("button", { type: "button", onclick: () => view.turn(!view.turns), title: "Heading or north at the top (H)" }, "Heading up");
  const ego = h("button", { type: "button", onclick: () => view.follow("ego"), title: "Follow the car (F)" }, "Follow the car");
  view.changed = () => {
    turn.setAttribute("aria-pressed", String(view.turns));
    ego.setAttribute("aria-pressed", String(view.follows === "ego"));
  };
  view.changed();

  play.addEventListener("click", () => run_(!playing));
  slider.addEventListener("input", () => jump(Number(slider.value)));
  live.addEventListener("click", () => { following = !following; live.setAttribute("aria-pressed", String(following)); if (following) run_(true); });
  const keys = (event) => {
    if (event.target.closest?.("input:not([type=range]), select, button, summary, a") && event.key === " ") return;
    if (event.target.closest?.("input[type=search], select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
    const known = { " ": () => run_(!playing), ",": () => hop(-1), ".": () => hop(1) };
    if (known[event.key]) { event.preventDefault(); known[event.key](); }
  };
  document.addEventListener("keydown", keys);

  async function again() {
    try {
      const had = `${steps.length} ${run.scenario}`;
      running = await poll();
      note.hidden = true;
      if (!running || !run.scenario) run = await ask(base); // at the very beginning nothing is known about it
      if (!running || `${steps.length} ${run.scenario}` !== had) head();
      lists();
      show();
    } catch (error) {
      note.textContent = `${error.message} Trying again.`;
      note.hidden = false;
    }
    if (running) timer = setTimeout(again, POLL_MS);
  }

  const copied = h("span", { class: "muted", role: "status" });
  const copy = button("Copy the link", async () => {
    history.replaceState(null, "", link());
    try { await navigator.clipboard.writeText(location.href); copied.textContent = "copied"; }
    catch { copied.textContent = "the link is in the address bar"; }
  }, "A link to this instant");

  head();
  lists();
  return {
    title: run.task,
    content: [heading, note,
      h("div", { class: run.of_study ? "stage wide" : "stage" },
        run.of_study ? null : h("figure", { class: "cockpit card" }, ahead, box),
        h("figure", { class: "card map" }, canvas,
          h("div", { class: "tools" }, button("+", () => view.zoom(1.4), "Zoom in (+)"), button("−", () => view.zoom(1 / 1.4), "Zoom out (−)"), ego, turn, button("All roads", () => view.whole(), "All recorded roads (0)")),
          h("figcaption", {}, about, vehicle))),
      h("div", { class: "card transport" },
        play, button("‹ Step", () => hop(-1), "Previous step (,)"), button("Step ›", () => hop(1), "Next step (.)"), live,
        h("div", { class: "time-line" }, slider, marks), clock, speed, copy, copied),
      h("div", { class: "columns" },
        h("section", {}, h("h2", {}, run.of_study ? "Decisions" : "Steps"), h("div", { class: "card" }, list)),
        h("section", {}, h("h2", {}, run.of_study ? "Details" : "This step"), detail)),
      verdict,
      h("div", { class: "columns even" },
        run.of_study ? null : h("section", {}, h("h2", {}, "Events"), h("div", { class: "card" }, events)),
        h("section", {}, h("h2", {}, "Speed and limit"), plot, level)),
      h("p", { class: "muted hash" }, run.trace_sha256 ? `Trace ${run.trace_sha256}` : "")],
    ready: () => {
      jump(query.has("at") && Number.isFinite(Number(query.get("at"))) ? Number(query.get("at")) : running ? (following ? end() : road.begin) : 0, true);
      if (running) { run_(true); timer = setTimeout(again, POLL_MS); }
    },
    isOver: () => !running && at >= end() - 0.05,
    leave: () => {
      clearTimeout(timer);
      clearTimeout(saved);
      cancelAnimationFrame(frame);
      document.removeEventListener("keydown", keys);
      view.leave();
    },
  };
}
