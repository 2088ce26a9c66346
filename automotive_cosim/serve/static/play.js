// A person at the cockpit: what an agent is told, and the same acts, in real time.

import { ask, h, plain, seconds, send } from "./dom.js";

const [WIDE, HIGH] = [1280, 720];
const TAP_PX = 16;
const HOLD_MS = 550;
const SCROLL_MS = 250;
const REASONS = ["none", "law", "safety", "already_so", "not_possible"];
const KEYS = { Escape: { action_type: "navigate_back" }, Home: { action_type: "navigate_home" } };

export async function playPage(query) {
  const { plays } = await ask("/api/about");
  if (!plays) {
    return { title: "Play", content: [h("h1", {}, "Play"), h("p", { class: "card" }, "Start `automotive-cosim serve --play` to work the cockpit yourself.")] };
  }
  const { tasks } = await ask("/api/tasks");
  let scene = await ask("/api/play");
  let gone = false;
  let timer = 0;

  const main = h("div");
  const note = h("p", { class: "warning", hidden: true, role: "alert" });
  const status = h("p", { class: "muted", role: "status" });
  const say = (error) => { note.textContent = error?.message ?? ""; note.hidden = !error; };
  const act = async (action) => { try { await send("/api/play/act", action); say(null); } catch (error) { say(error); } };

  // --- before: which task ---

  const task = h("select", {}, h("option", { value: "" }, "Deal me one"), tasks.map(({ id }) => h("option", { value: id, selected: id === query.get("task") }, id)));
  const name = h("input", { type: "text", placeholder: "nobody", maxlength: 40 });
  const seed = h("input", { type: "number", min: 0, max: 2147483647, value: Math.floor(Math.random() * 1000) });
  const begin = h("button", { type: "submit", class: "main" }, "Begin");
  const form = h("form", { class: "card filters", onsubmit: async (event) => {
    event.preventDefault();
    const chosen = task.value || tasks[Math.floor(Math.random() * tasks.length)].id;
    try { await send("/api/play/start", { task: chosen, half: "", seed: Number(seed.value), name: name.value }); say(null); } catch (error) { say(error); }
  } }, h("label", {}, "Task", task), h("label", {}, "Your code name", name), h("label", {}, "Seed", seed), begin);
  const rules = h("div", { class: "card" },
    h("h2", {}, "What you know, and what counts"),
    h("ul", { class: "rules" }, [
      "You get what an agent gets: the driver's words, the screen, the car's receivers and what is said about the place.",
      "The road does not wait. An act takes a second; a second without an act goes by.",
      "Do what the driver needs, and nothing else. Sometimes nothing is right, or what is asked must not be done: then say so.",
      "At the end declare: done, not needed, or that it cannot or must not be done. The verdict is the agents' own.",
      "Tap, hold, drag and scroll on the screen; click a text field to type. Tab and Enter work, too; Escape is back, Home is home.",
    ].map((text) => h("li", {}, text))));

  // --- during ---

  const screen = h("img", { class: "screen", alt: "The cockpit's screen", draggable: "false" });
  const ripple = h("i", { class: "ripple", hidden: true });
  const buttons = h("div", { class: "elements" });
  const frame = h("div", { class: "frame touch" }, screen, buttons, ripple);
  const words = h("p", { class: "said" });
  const told = h("p", { class: "muted", role: "status" });
  const context = h("pre");
  const typed = h("form", { class: "filters", hidden: true });
  const reason = h("select", { "aria-label": "Reason for declining" }, REASONS.map((each) => h("option", { value: each }, each === "none" ? "no reason" : plain(each))));
  const declare = (status_) => act({ action_type: "status", goal_status: status_, reason: status_ === "complete" ? "none" : reason.value });
  const answer = h("input", { type: "text", "aria-label": "Say to the driver, or ask", placeholder: "Say to the driver, or ask" });
  const button = (label, action, kind) => h("button", { type: "button", class: kind, onclick: action }, label);
  const cockpit = h("div", { class: "playing" },
    words, h("div", { class: "card stage-one" }, frame), typed,
    h("div", { class: "card transport" },
      button("Back", () => act({ action_type: "navigate_back" })), button("Home", () => act({ action_type: "navigate_home" })), button("Enter", () => act({ action_type: "keyboard_enter" })),
      h("form", { class: "filters say", onsubmit: (event) => { event.preventDefault(); if (answer.value) act({ action_type: "answer", text: answer.value }); answer.value = ""; } }, answer, h("button", { type: "submit" }, "Say"), button("Ask", () => { if (answer.value) act({ action_type: "ask_driver", text: answer.value }); answer.value = ""; })),
      button("Done", () => declare("complete"), "main"), button("Not needed", () => declare("not_needed")), button("Cannot or must not", () => declare("infeasible")), reason,
      button("Leave", async () => { try { await send("/api/play/leave", {}); } catch (error) { say(error); } })),
    told, h("details", { class: "card", open: true }, h("summary", {}, "What is known of the place"), context));

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
    typed.replaceChildren(input, h("button", { type: "submit", class: "main" }, "Type it"), h("button", { type: "button", onclick: () => { typed.hidden = true; } }, "Never mind"));
    typed.onsubmit = (event) => {
      event.preventDefault();
      typed.hidden = true;
      act({ action_type: "input_text", x: Math.round((field.box[0] + field.box[2]) / 2), y: Math.round((field.box[1] + field.box[3]) / 2), text: input.value, clear_text: true });
    };
    typed.hidden = false;
    input.focus();
  }

  function show() {
    const { state } = scene;
    const playing = state === "acting";
    if (playing) {
      const { told: now } = scene;
      if (main.firstChild !== cockpit) main.replaceChildren(cockpit);
      words.textContent = [now.goal, ...now.said].map((text) => `“${text}”`).join(" ");
      screen.src = `/api/play/screen?seen=${scene.version}`;
      told.textContent = `${seconds(now.time_s)} · ${plain(now.feedback[0])}${now.feedback[1] ? `: ${now.feedback[1]}` : ""}`;
      context.textContent = now.context;
      place(now.elements);
      status.textContent = "";
      return;
    }
    typed.hidden = true;
    const texts = {
      idle: "", warming: `The traffic warms up: ${Math.round(scene.progress * 100)} %`, driving: "The car drives to where the situation arises …",
      ending: "The road is watched a little longer, and the episode is judged and recorded …", over: "The episode is over.", failed: `There is no verdict: ${scene.error}`,
    };
    status.textContent = texts[state] ?? state;
    begin.disabled = ["warming", "driving", "ending"].includes(state);
    const bar = state === "warming" ? h("progress", { max: 1, value: scene.progress, "aria-label": "Warm-up" }) : null;
    const link = scene.record ? h("p", { class: "card" }, h("a", { href: `#/run/${scene.record}` }, "See the verdict, and the road with everybody on it")) : null;
    main.replaceChildren(...[bar, link, form, rules].filter(Boolean));
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
        if (event.detail) return; // a pointer's, which the frame has seen
        if (element.editable) type(element);
        else act({ action_type: "click", x: Math.round((box[0] + box[2]) / 2), y: Math.round((box[1] + box[3]) / 2) });
      } });
      Object.assign(made.style, { left: `${box[0] / 12.8}%`, top: `${box[1] / 7.2}%`, width: `${(box[2] - box[0]) / 12.8}%`, height: `${(box[3] - box[1]) / 7.2}%` });
      return made;
    }));
    if (focused) [...buttons.children].find((each) => each.getAttribute("aria-label") === focused)?.focus();
  }

  const keys = (event) => {
    if (scene.state !== "acting" || event.target.closest?.("input, select") || event.ctrlKey || event.metaKey || event.altKey || !KEYS[event.key]) return;
    event.preventDefault();
    act(KEYS[event.key]);
  };
  document.addEventListener("keydown", keys);

  async function listen() {
    while (!gone) {
      try {
        const next = await ask(`/api/play?seen=${scene.version}`);
        if (gone) return;
        if (next.version !== scene.version) { scene = next; show(); }
      } catch (error) {
        say(new Error(`${error.message} Trying again.`));
        await new Promise((done) => { timer = setTimeout(done, 1000); });
      }
    }
  }

  return {
    title: "Play",
    content: [h("h1", {}, "Play"), note, status, main],
    ready: () => { show(); listen(); },
    leave: () => { gone = true; clearTimeout(timer); document.removeEventListener("keydown", keys); },
  };
}
