// A person at the cockpit: the choice of a task, the cockpit in real time, and the link to the verdict.

import { ask, h, send } from "./dom.js";
import { cockpitPanel, listen, rulesCard, waiting } from "./cockpit.js";

const group = ({ suite, module }) => (suite === "standard" ? `Tasks: ${module}` : `Tasks of the suite ${suite}: ${module}`);

export async function playPage(query) {
  const { plays } = await ask("/api/about");
  if (!plays) {
    return { title: "Play", content: [h("h1", {}, "Play"), h("p", { class: "card" }, "Start `automotive-cosim serve --play` to operate the cockpit yourself.")] };
  }
  const [{ tasks }, { drives }] = await Promise.all([ask("/api/tasks"), ask("/api/drives")]);
  const main = h("div");
  const note = h("p", { class: "warning", hidden: true, role: "alert" });
  const status = h("p", { class: "muted", role: "status" });
  const say = (error) => { note.textContent = error?.message ?? ""; note.hidden = !error; };
  const cockpit = cockpitPanel({ say });

  const task = h("select", {}, h("option", { value: "" }, "Random, of the standard suite"),
    [...new Set(tasks.map(group))].map((label) => h("optgroup", { label }, tasks.filter((each) => group(each) === label)
      .map(({ id }) => h("option", { value: id, selected: id === query.get("task") }, id)))),
    h("optgroup", { label: "Drives, ten to thirty minutes" }, drives.map(({ id }) => h("option", { value: `drive ${id}` }, id))));
  const name = h("input", { type: "text", maxlength: 40 });
  const seed = h("input", { type: "number", min: 0, max: 2147483647, value: Math.floor(Math.random() * 1000) });
  const practice = h("input", { type: "checkbox" });
  const begin = h("button", { type: "submit", class: "main" }, "Begin");
  const form = h("form", { class: "card filters", onsubmit: async (event) => {
    event.preventDefault();
    const standard = tasks.filter(({ suite }) => suite === "standard");
    const chosen = task.value || standard[Math.floor(Math.random() * standard.length)].id;
    const [what, id] = chosen.startsWith("drive ") ? ["drive", chosen.slice(6)] : ["task", chosen];
    begin.disabled = true;
    try { await send("/api/play/start", { [what]: id, half: "", seed: Number(seed.value), name: name.value, practice: practice.checked }); say(null); } catch (error) { begin.disabled = false; say(error); }
  } }, h("label", {}, "Task or drive", task), h("label", {}, "Your code name", name), h("label", {}, "Seed", seed), begin,
  h("label", { class: "check" }, practice, "Practice: the clock can be stopped or slowed, and the result is not counted"));

  const rules = rulesCard();

  function show(scene) {
    if (scene.state === "acting") {
      if (main.firstChild !== cockpit.element) main.replaceChildren(cockpit.element);
      cockpit.show(scene);
      status.textContent = "";
      return;
    }
    cockpit.hide();
    const [text, bar] = waiting(scene);
    status.textContent = text;
    begin.disabled = ["warming", "driving", "ending"].includes(scene.state);
    const episode = scene.episode ? `/${encodeURIComponent(scene.episode)}` : "";
    const link = scene.record ? h("p", { class: "card" }, h("a", { href: `#/run/${scene.record}${episode}` }, "See the verdict, and the road with all vehicles")) : null;
    main.replaceChildren(...[bar, link, form, rules].filter(Boolean));
  }

  let stop = () => {};
  return {
    title: "Play",
    content: [h("h1", {}, "Play"), note, status, main],
    ready: () => { stop = listen({ say, changed: show }); },
    leave: () => { stop(); cockpit.leave(); },
  };
}
