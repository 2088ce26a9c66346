// The detection-response task of ISO 17488: a red dot every few seconds, which a key answers. What came of each goes to `report`.

import { h } from "./dom.js";

const KEY = "Control"; // changes nothing on the page, in no field

export function detector({ every_ms: [least, most], shown_ms: shown, valid_ms: [, latest] }, report) {
  const dot = h("i", { class: "dot", hidden: true, "aria-hidden": "true" });
  const element = h("p", { class: "card detecting" }, h("span", { class: "spot" }, dot), "Each time the red dot appears, press Ctrl, or tap here, as soon as you can.");
  let [phase, onset, timers] = ["", null, []];
  const later = (ms, what) => timers.push(setTimeout(what, ms));
  const clear = () => { timers.forEach(clearTimeout); timers = []; dot.hidden = true; onset = null; };
  const over = (reaction) => { dot.hidden = true; onset = null; report({ phase, reaction_ms: reaction }); };

  function next() {
    later(least + Math.random() * (most - least), () => {
      timers = [];
      dot.hidden = false;
      requestAnimationFrame((now) => { onset = now; }); // when it is drawn
      later(shown, () => { dot.hidden = true; });
      later(latest, () => { if (onset !== null) over(null); });
      next();
    });
  }

  const answered = (event) => {
    if (onset === null || (event.type === "keydown" && (event.key !== KEY || event.repeat))) return;
    over(Math.max(0, Math.round(10 * (event.timeStamp - onset)) / 10));
  };
  document.addEventListener("keydown", answered);
  element.addEventListener("pointerdown", answered);

  return {
    element,
    during: (now) => { if (now === phase) return; clear(); phase = now; if (phase) next(); },
    leave: () => { clear(); document.removeEventListener("keydown", answered); },
  };
}
