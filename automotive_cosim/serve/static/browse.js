// The catalogue of tasks, one task, and the scenarios.

import { ask, counted, h, plain } from "./dom.js";

const AT_ONCE = 50;

export async function tasksPage(query) {
  const tasks = (await ask("/api/tasks")).tasks.map((task) => ({ ...task, halves: task.pair ? "pair" : "single" }));
  const list = h("ul", { class: "records" });
  const count = h("p", { class: "muted", role: "status" });
  const search = h("input", { type: "search", "aria-label": "Search the tasks", placeholder: "Search ids and words", value: query.get("q") ?? "" });
  const choices = [["suite", "Suite"], ["module", "Module"], ["dimension", "Dimension"], ["ability", "Ability"], ["halves", "Halves"], ["difficulty", "Difficulty"]].map(([name, label]) =>
    h("select", { name, "aria-label": label }, h("option", { value: "" }, `${label}: all`),
      [...new Set(tasks.map((task) => task[name]).filter(Boolean))].sort().map((value) => h("option", { value, selected: value === query.get(name) }, plain(value)))));
  const more = h("button", { type: "button", onclick: () => fill(list.children.length + AT_ONCE) });
  const fill = (most) => {
    const wanted = search.value.toLowerCase();
    const kept = tasks.filter((task) => choices.every((choice) => !choice.value || task[choice.name] === choice.value)
      && [task.id, task.said, ...task.goal_templates].join(" ").toLowerCase().includes(wanted));
    count.textContent = `${kept.length} of ${tasks.length} tasks, ${kept.filter((task) => task.suite === "standard").length} of them in the standard suite`;
    more.hidden = kept.length <= most;
    more.textContent = `Show ${Math.min(AT_ONCE, kept.length - most)} more of ${kept.length}`;
    list.replaceChildren(...kept.slice(0, most).map((task) => h("li", { class: "card" },
      h("div", {}, h("a", { href: `#/tasks/${task.id}` }, task.id), h("p", {}, `“${task.said}”`),
        h("p", { class: "muted" }, [task.suite, task.module, plain(task.dimension), plain(task.ability), task.difficulty, counted(task.optimal_steps, "step")].filter(Boolean).join(" · "))),
      task.pair ? h("span", { class: "pill quiet" }, "Pair") : null)));
    const parameters = new URLSearchParams();
    choices.forEach((choice) => choice.value && parameters.set(choice.name, choice.value));
    if (search.value) parameters.set("q", search.value);
    const text = parameters.toString();
    history.replaceState(null, "", `#/tasks${text ? `?${text}` : ""}`);
  };
  const anew = () => fill(AT_ONCE);
  search.addEventListener("input", anew);
  choices.forEach((choice) => choice.addEventListener("change", anew));
  return { title: "Tasks", content: [h("h1", {}, "Tasks"), h("div", { class: "filters" }, search, choices), count, list, h("p", { class: "more" }, more)], ready: anew };
}

export async function taskPage(query, id) {
  const task = await ask(`/api/tasks/${id}`);
  const { halves: solved } = await ask(`/api/tasks/${id}/reference`);
  const said = task.goal_templates.join(" ");
  const values = Object.entries(task.values).filter(([name]) => said.includes(`{${name}}`)).map(([name, said]) => h("li", {}, h("code", {}, `{${name}}`), ` ${said}`));
  return {
    title: task.id,
    content: [
      h("h1", {}, task.id),
      h("p", { class: "muted" }, [task.module, plain(task.dimension), task.difficulty, counted(task.optimal_steps, "step"), `runs in ${task.scenarios.join(", ")}`].join(" · ")),
      h("p", {}, h("a", { href: `#/play?task=${task.id}` }, "Play this task")),
      h("h2", {}, "What the driver says"),
      h("ul", { class: "card words" }, task.goal_templates.map((words) => h("li", {}, `“${words}”`))),
      values.length > 0 && h("ul", { class: "muted" }, values),
      h("dl", {}, task.trail.map(([label, said]) => [h("dt", {}, label), h("dd", {}, said)])),
      task.difference && h("h2", {}, "The one difference between the halves"),
      task.difference && h("p", { class: "card" }, task.difference),
      h("div", { class: "halves" }, task.halves.map((half) => h("section", { class: "card" },
        h("h2", {}, task.halves.length > 1 ? `The ${half.name} half` : "The situation"),
        h("dl", {}, half.words.map(([label, said]) => [h("dt", {}, label), h("dd", {}, ticked(said))])),
        reference(solved[half.name], id, half.name),
        half.laws.map((law) => h("blockquote", {}, h("p", {}, law.text), h("footer", { class: "muted" }, `${law.law}, as of ${law.as_of} (${law.status})`)))))),
    ].filter(Boolean),
  };
}

// A text whose words in backticks are code.
const ticked = (text) => text.split("`").map((part, index) => (index % 2 ? h("code", {}, part) : part));

// The reference solution as pictures, if a record here has them.
function reference(found, id, half) {
  if (!found) return h("p", { class: "muted" }, "To see the reference solution as pictures: ", h("code", {}, `automotive-cosim run --task ${id} --half ${half} --agent oracle`));
  const base = `/api/runs/${found.run}${found.episode ? `/episodes/${encodeURIComponent(found.episode)}` : ""}`;
  return h("details", { open: true }, h("summary", {}, "The reference solution"), h("ol", { class: "film" }, found.steps.filter((each) => each.has_picture).map((each) => h("li", {},
    h("img", { src: `${base}/pictures/${each.picture}`, alt: `The screen after: ${each.words}`, loading: "lazy" }), h("span", {}, each.number ? `${each.number}  ${each.words}` : "the screen at the hand-over")))),
  h("p", {}, h("a", { href: `#/run/${found.run}${found.episode ? `/${encodeURIComponent(found.episode)}` : ""}` }, "See it on the road")));
}

export async function scenariosPage() {
  const { scenarios } = await ask("/api/scenarios");
  return {
    title: "Scenarios",
    content: [h("h1", {}, "Scenarios"), h("div", { class: "maps" }, scenarios.map((scenario) => h("article", { class: "card" },
      scenario.has_map && h("a", { href: `/api/scenarios/${scenario.name}/map`, target: "_blank" }, h("img", { src: `/api/scenarios/${scenario.name}/map`, alt: `Map of ${scenario.title}`, loading: "lazy" })),
      h("h2", {}, scenario.title),
      h("p", { class: "muted" }, [scenario.name, scenario.country, scenario.starts].filter(Boolean).join(" · ")),
      h("p", {}, scenario.about),
      h("details", {}, h("summary", {}, `${counted(scenario.trips.length, "trip")}, ${counted(scenario.tasks.length, "task")}`),
        h("ul", {}, scenario.trips.map(([name, about]) => h("li", {}, h("b", {}, name), `: ${about}`))),
        h("p", {}, scenario.tasks.flatMap((id) => [h("a", { href: `#/tasks/${id}` }, id), " "]))))))],
  };
}
