// A running study: its drives one after another, each as it was simulated, only slower.

import { ask, h } from "./dom.js";
import { replayPage } from "./replay.js";

const EVERY_MS = 1000;
const SPEED = 16; // a study drives many times faster than anybody could watch

export async function livePage(query, id) {
  const status = h("p", { class: "muted", role: "status" });
  const { name } = await ask(`/api/studies/${id}/live`);
  const place = h("div", {}, h("h1", {}, `${name}, live`));
  let drive = null;
  let shown = null;
  let gone = false;
  let timer = 0;

  async function again() {
    try {
      const { running, drives } = await ask(`/api/studies/${id}/live`);
      const next = drives.find((each) => each !== drive);
      if (next && (!shown || shown.isOver())) await show(next);
      if (gone) return;
      if (!running) status.replaceChildren("The study is not running. ", h("a", { href: `#/decisions/${id}` }, "See its decisions"));
      else status.textContent = shown?.isOver() ?? true ? "Waiting for the next drive: the traffic is warming up, or routes are being driven to their ends." : `Showing drive ${drive}; the next one starts when it ends.`;
    } catch (error) {
      status.textContent = `${error.message} Trying again.`;
    }
    if (!gone) timer = setTimeout(again, EVERY_MS);
  }

  async function show(next) {
    const page = await replayPage(new URLSearchParams({ speed: SPEED }), id, next);
    if (gone) return page.leave();
    shown?.leave();
    [drive, shown] = [next, page];
    place.replaceChildren(...page.content);
    page.ready();
  }

  return {
    title: `${name}, live`,
    content: [status, place],
    ready: again,
    leave: () => { gone = true; clearTimeout(timer); shown?.leave(); },
  };
}
