// Words by the browser's own recogniser, into a field; nothing where the browser has none. It listens only while its button is on.

import { h } from "./dom.js";

export function speaker(field, say) {
  const Recogniser = window.SpeechRecognition ?? window.webkitSpeechRecognition;
  if (!Recogniser) return null;
  let listening = null;
  const button = h("button", { type: "button", "aria-pressed": "false", onclick: () => (listening ? listening.stop() : listen()) }, "Speak");
  const show = (on) => { button.setAttribute("aria-pressed", String(on)); button.textContent = on ? "Stop" : "Speak"; };

  function listen() {
    listening = Object.assign(new Recogniser(), {
      lang: "en-US",
      interimResults: true,
      onresult: ({ results }) => { field.value = Array.from(results, ([best]) => best.transcript).join(" ").trim().slice(0, field.maxLength); },
      onerror: ({ error }) => say(new Error(`Your browser recognised nothing (${error}). Type instead.`)),
      onend: () => { listening = null; show(false); },
    });
    try { listening.start(); show(true); } catch (error) { listening = null; say(error); }
  }

  return h("span", { class: "speech" }, button, h("span", { class: "muted" }, "Off until you press it. Your browser makes text of what you say; some browsers send the sound to their maker’s server."));
}
