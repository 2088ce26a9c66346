// The cockpit for a person: its screen, the information that an agent gets, and the same acts.

import { ask, h, plain, seconds, send } from "./dom.js";
import { speaker } from "./speech.js";

const [WIDE, HIGH] = [1280, 720];
const TAP_PX = 16;
const HOLD_MS = 550;
const SCROLL_MS = 250;
const SPEEDS = [1, 0.5, 0.25];
const REASONS = ["none", "law", "safety", "already_so", "not_possible"];
const KEYS = { Escape: { action_type: "navigate_back" }, Home: { action_type: "navigate_home" } };

export const RULES = [
  "You get what an agent gets: the driver's words, the screen, the readings of the car and its receivers, and the facts about the place. You see neither the road nor the verdict.",
  "The traffic does not wait. Each action takes one second, and the clock also runs while you do nothing. An episode ends after two minutes.",
  "Do what the driver needs, and nothing else. Sometimes nothing has to be done, or the request must not be granted: then say so.",
  "Ask the driver only for what you cannot find out otherwise. Use “Look up” for rules, weather and roads; warnings are on the screen “Safety”.",
  "At the end, declare: done, not needed, or that it cannot or must not be done, with the reason if you can. You are judged by the same checks as an agent.",
  "Tap, hold, drag and scroll on the screen; click a text field to type. Tab and Enter work too; Escape is back, Home is home.",
];

export function rulesCard() {
  return h("div", { class: "card" }, h("h2", {}, "What you know, and what counts"), h("ul", { class: "rules" }, RULES.map((text) => h("li", {}, text))));
}

// Plays one person's episodes: `base` is the server's path, `query` identifies the person, `say` shows an error.
export function cockpitPanel({ base = "/api/play", query = {}, say, leaveLabel = "Quit" }) {
  const address = (what, more = {}) => `${base}${what}?${new URLSearchParams({ ...query, ...more })}`;
  const act = async (action) => { try { foresee(await send(address("/act"), action)); say(null); } catch (error) { say(error); } };
  let scene = null;
  let became = ""; // the last act's feedback: a second without an act has none

  const screen = h("img", { class: "screen", alt: "The cockpit's screen", draggable: "false" });
  const ripple = h("i", { class: "ripple", hidden: true });
  const buttons = h("div", { class: "elements" });
  const frame = h("div", { class: "frame touch" }, screen, buttons, ripple);
  const words = h("p", { class: "said" });
  const told = h("p", { class: "muted", role: "status" });
  const context = h("pre");
  const readings = h("dl", { class: "readings" });
  const typed = h("form", { class: "filters", hidden: true });
  const reason = h("select", { "aria-label": "Reason for declining" }, REASONS.map((each) => h("option", { value: each }, each === "none" ? "No reason given" : each === "already_so" ? "Already done" : plain(each))));
  const declare = (status_) => act({ action_type: "status", goal_status: status_, reason: status_ === "complete" ? "none" : reason.value });
  const answer = h("input", { type: "text", maxlength: 120, "aria-label": "Say to the driver, ask, or look up", placeholder: "Say, ask, or look up" });
  const button = (label, action, kind) => h("button", { type: "button", class: kind, onclick: action }, label);
  const speak = (action_type) => { if (answer.value) act({ action_type, text: answer.value }); answer.value = ""; };

  // only in practice
  const pace = async (changes) => { try { await send(address("/pace"), { speed: scene.speed, paused: scene.paused, ...changes }); say(null); } catch (error) { say(error); } };
  const pause = button("Pause", () => pace({ paused: !scene.paused }));
  const speed = h("select", { "aria-label": "Speed of the road", onchange: () => pace({ speed: Number(speed.value) }) }, SPEEDS.map((value) => h("option", { value }, `${value}×`)));
  const practice = h("div", { class: "card transport", hidden: true }, h("span", { class: "pill" }, "practice"), pause, speed, h("span", { class: "muted" }, "The result is not counted."));

  const element = h("div", { class: "playing" }, h("div", {}, h("div", { class: "exchange" }, words, told),
    h("div", { class: "card stage-one" }, frame), typed,
    h("div", { class: "card transport" },
      button("Back", () => act({ action_type: "navigate_back" })), button("Home", () => act({ action_type: "navigate_home" })), button("Enter", () => act({ action_type: "keyboard_enter" })),
      h("form", { class: "filters say", onsubmit: (event) => { event.preventDefault(); speak("answer"); } }, answer, h("button", { type: "submit" }, "Say"), button("Ask", () => speak("ask_driver")), button("Look up", () => speak("query"))), speaker(answer, say)),
    h("div", { class: "card transport" }, h("span", { class: "muted" }, "When finished:"),
      button("Done", () => declare("complete"), "main"), button("Not needed", () => declare("not_needed")), button("Can't or not allowed", () => declare("infeasible")), reason,
      h("span", { class: "leave" }, button(leaveLabel, async () => { try { await send(address("/leave"), {}); } catch (error) { say(error); } })))),
  h("div", {}, practice, h("details", { class: "card", open: true }, h("summary", {}, "What is known about the place"), context),
    h("details", { class: "card" }, h("summary", {}, "Readings of the car and its receivers"), readings)));

  // The answer to an act holds the screen as the act will leave it; the road follows within a second.
  let look = -1;
  const picture = (address) => {
    if (screen.src.startsWith("blob:")) URL.revokeObjectURL(screen.src);
    screen.src = address;
  };
  const foresee = (blob) => picture(URL.createObjectURL(blob));

  const point = (event) => {
    const box = frame.getBoundingClientRect();
    return [Math.round((event.clientX - box.left) / box.width * WIDE), Math.round((event.clientY - box.top) / box.height * HIGH)].map((value, index) => Math.max(0, Math.min([WIDE, HIGH][index] - 1, value)));
  };
  let down = null;
  frame.addEventListener("pointerdown", (event) => { down = { at: point(event), since: performance.now() }; frame.setPointerCapture(event.pointerId); });
  frame.addEventListener("pointerup", (event) => {
    if (!down) return;
    const [start, end, held] = [down.at, point(event), performance.now() - down.since];
    down = null;
    const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    const [x, y] = start;
    const far = Math.round(Math.max(Math.abs(dx), Math.abs(dy)));
    Object.assign(ripple.style, { left: `${x / 12.8}%`, top: `${y / 7.2}%` });
    ripple.hidden = false;
    ripple.getAnimations().forEach((animation) => { animation.cancel(); animation.play(); });
    const field = scene.told?.elements.find(({ editable, box }) => editable && x >= box[0] && x < box[2] && y >= box[1] && y < box[3]);
    if (Math.hypot(dx, dy) < TAP_PX) {
      if (field) type(field);
      else act({ action_type: held > HOLD_MS ? "long_press" : "click", x, y });
    } else act({ action_type: "swipe", x, y, direction: Math.abs(dx) > Math.abs(dy) ? (dx > 0 ? "right" : "left") : (dy > 0 ? "down" : "up"), distance_px: far });
  });
  frame.addEventListener("pointercancel", () => { down = null; });
  let scrolled = 0;
  frame.addEventListener("wheel", (event) => {
    event.preventDefault();
    const now = performance.now();
    if (now - scrolled < SCROLL_MS) return;
    scrolled = now;
    act({ action_type: "scroll", direction: event.deltaY > 0 ? "down" : "up" });
  }, { passive: false });

  function type(field) {
    const input = h("input", { type: "text", "aria-label": `Type into ${field.text}`, placeholder: field.text });
    typed.replaceChildren(input, h("button", { type: "submit", class: "main" }, "Enter text"), h("button", { type: "button", onclick: () => { typed.hidden = true; } }, "Cancel"));
    typed.onsubmit = (event) => {
      event.preventDefault();
      typed.hidden = true;
      act({ action_type: "input_text", x: Math.round((field.box[0] + field.box[2]) / 2), y: Math.round((field.box[1] + field.box[3]) / 2), text: input.value, clear_text: true });
    };
    typed.hidden = false;
    input.focus();
  }

  function show(now) {
    scene = now;
    const { told: seen } = scene;
    words.textContent = [seen.goal, ...seen.said].map((text) => `“${text}”`).join(" ");
    if (look !== scene.look) picture(address("/screen", { seen: scene.look }));
    look = scene.look;
    if (seen.feedback[1] || seen.feedback[0] !== "ok") became = `${plain(seen.feedback[0])}${seen.feedback[1] ? `: ${seen.feedback[1]}` : ""}`;
    told.textContent = `${scene.paused ? "clock stopped · " : ""}${seconds(seen.time_s)} · ${became}`;
    context.textContent = seen.context;
    readings.replaceChildren(...Object.entries(seen.readings).flatMap(([name, value]) => [h("dt", {}, plain(name)), h("dd", {}, String(value))]));
    practice.hidden = !scene.practice;
    pause.textContent = scene.paused ? "Resume" : "Pause";
    speed.value = scene.speed;
    place(seen.elements);
  }

  // Invisible buttons where the screen's elements are, for the keyboard and for screen readers.
  function place(elements) {
    const key = JSON.stringify(elements);
    if (buttons.dataset.key === key) return;
    buttons.dataset.key = key;
    const focused = document.activeElement?.parentElement === buttons ? document.activeElement.getAttribute("aria-label") : null;
    buttons.replaceChildren(...elements.map((element) => {
      const { box } = element;
      const made = h("button", { type: "button", "aria-label": element.text, "aria-pressed": element.checked ? "true" : undefined, onclick: (event) => {
        if (event.detail) return; // from a pointer, which the frame has handled
        if (element.editable) type(element);
        else act({ action_type: "click", x: Math.round((box[0] + box[2]) / 2), y: Math.round((box[1] + box[3]) / 2) });
      } });
      Object.assign(made.style, { left: `${box[0] / 12.8}%`, top: `${box[1] / 7.2}%`, width: `${(box[2] - box[0]) / 12.8}%`, height: `${(box[3] - box[1]) / 7.2}%` });
      return made;
    }));
    if (focused) [...buttons.children].find((each) => each.getAttribute("aria-label") === focused)?.focus();
  }

  const keys = (event) => {
    if (scene?.state !== "acting" || !element.isConnected || event.target.closest?.("input, select") || event.ctrlKey || event.metaKey || event.altKey || !KEYS[event.key]) return;
    event.preventDefault();
    act(KEYS[event.key]);
  };
  document.addEventListener("keydown", keys);

  return {
    element,
    show,
    hide: () => { typed.hidden = true; },
    leave: () => document.removeEventListener("keydown", keys),
  };
}

// Receives every change of a person's scene until it is stopped.
export function listen({ base = "/api/play", query = {}, say, changed }) {
  let [gone, timer, version, lost] = [false, 0, -1, false];
  (async () => {
    while (!gone) {
      try {
        const scene = await ask(`${base}?${new URLSearchParams({ ...query, ...(version < 0 ? {} : { seen: version }) })}`);
        if (gone) return;
        if (lost) say(null);
        lost = false;
        if (scene.version !== version) { version = scene.version; changed(scene); }
      } catch (error) {
        lost = true;
        say(new Error(`${error.message} Trying again.`));
        await new Promise((done) => { timer = setTimeout(done, 1000); });
      }
    }
  })();
  return () => { gone = true; clearTimeout(timer); };
}

export function waiting(scene) {
  const texts = {
    idle: "", warming: `The traffic is warming up: ${Math.round(scene.progress * 100)} %`, driving: "The car is driving to where the situation arises …",
    ending: "The drive continues for a few seconds, then the episode is judged and recorded …", over: "The episode is over.", failed: `There is no verdict: ${scene.error}`,
  };
  const bar = scene.state === "warming" ? h("progress", { max: 1, value: scene.progress, "aria-label": "Warm-up" }) : null;
  return [texts[scene.state] ?? scene.state, bar];
}
