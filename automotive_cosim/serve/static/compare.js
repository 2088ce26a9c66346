// Two evaluations, or two agents of one, side by side: instance by instance, and two episodes step by step.

import { ask, counted, h, modelName, outcome, plain, seconds } from "./dom.js";
import { RoadRecord, RoadView } from "./road.js";

const MOST = 400;
const label = (row) => [row.agent, row.model !== "none" && modelName(row.model), ...row.conditions].filter(Boolean).join(", ");
const instance = (row) => [row.task, row.half, row.scenario, row.seed, row.repeat].join(" ");
const won = (row) => (row?.success === true ? "won" : row?.success === false ? "lost" : row ? "error" : "not run");
const CHANGES = { "": "all episodes", differs: "different outcome", better: "only the second won", worse: "only the first won", both: "both won", neither: "neither won" };

function change(one, other) {
  const [a, b] = [won(one), won(other)];
  return { differs: a !== b, better: b === "won" && a !== "won", worse: a === "won" && b !== "won", both: a === "won" && b === "won", neither: a !== "won" && b !== "won" };
}

export async function comparePage(query, first, second) {
  const runs = [await ask(`/api/evaluations/${first}`), await ask(`/api/evaluations/${second}`)];
  const sides = runs.map((run, index) => {
    const labels = [...new Set(run.rows.map(label))].sort();
    const wanted = query.get(index ? "b" : "a") ?? labels[first === second ? Math.min(index, labels.length - 1) : 0];
    return h("select", { "aria-label": index ? "Second agent" : "First agent" }, labels.map((name) => h("option", { value: name, selected: name === wanted }, name)));
  });
  const which = h("select", { "aria-label": "Which episodes" }, Object.entries(CHANGES).map(([value, words]) => h("option", { value, selected: value === query.get("show") }, words)));
  const modules = [...new Set(runs.flatMap((run) => run.rows.map((row) => row.module)))].sort();
  const module = h("select", { "aria-label": "Module" }, h("option", { value: "" }, "Module: all"), modules.map((name) => h("option", { value: name, selected: name === query.get("module") }, name)));
  const search = h("input", { type: "search", "aria-label": "Search for a task", placeholder: "Search tasks", value: query.get("q") ?? "" });
  const count = h("p", { class: "muted", role: "status" });
  const body = h("tbody");

  function fill() {
    const found = new Map();
    runs.forEach((run, index) => run.rows.filter((row) => label(row) === sides[index].value).forEach((row) => {
      found.set(instance(row), Object.assign(found.get(instance(row)) ?? [], { [index]: row }));
    }));
    const all = [...found.values()].map((pair) => [pair[0], pair[1]]);
    const kept = all.filter(([one, other]) => (!which.value || change(one, other)[which.value])
      && (!module.value || (one ?? other).module === module.value) && (one ?? other).task.includes(search.value.toLowerCase()));
    heads.forEach((each, index) => { each.textContent = first === second ? sides[index].value : `${runs[index].name}: ${sides[index].value}`; });
    const tally = (name) => all.filter(([one, other]) => change(one, other)[name]).length;
    count.textContent = `${counted(all.length, "episode")}: both won ${tally("both")}, only the first ${tally("worse")}, only the second ${tally("better")}, neither ${tally("neither")}. ${kept.length} shown${kept.length > MOST ? `, the first ${MOST}` : ""}.`;
    body.replaceChildren(...kept.slice(0, MOST).map(([one, other]) => {
      const row = one ?? other;
      const step = one?.has_trace && other?.has_trace ? h("a", { href: `#/beside/${first}/${encodeURIComponent(one.id)}/${second}/${encodeURIComponent(other.id)}` }, "step by step") : null;
      return h("tr", {}, h("td", {}, row.task), h("td", {}, row.half), h("td", {}, row.scenario), h("td", {}, `${row.seed}${row.repeat ? ` · ${row.repeat + 1}` : ""}`), cell(first, one), cell(second, other), h("td", {}, step));
    }));
    const kept_ = new URLSearchParams({ a: sides[0].value, b: sides[1].value });
    if (which.value) kept_.set("show", which.value);
    if (module.value) kept_.set("module", module.value);
    if (search.value) kept_.set("q", search.value);
    history.replaceState(null, "", `#/compare/${first}/${second}?${kept_}`);
  }

  function cell(id, row) {
    if (!row) return h("td", { class: "muted" }, "not run");
    const why = row.error ? row.error_kind : row.missing.map(plain).join(", ");
    return h("td", {}, row.has_trace ? h("a", { href: `#/run/${id}/${encodeURIComponent(row.id)}` }, outcome(row)) : outcome(row), why && h("span", { class: "muted" }, ` ${why}`));
  }

  for (const each of [...sides, which, module]) each.addEventListener("change", fill);
  search.addEventListener("input", fill);
  const head = ["Task", "Half", "Scenario", "Seed", "", "", "Both"].map((name) => h("th", { scope: "col" }, name));
  const heads = head.slice(4, 6);
  return {
    title: `${runs[0].name} and ${runs[1].name}`,
    content: [h("h1", {}, first === second ? `${runs[0].name}: two agents` : `${runs[0].name} and ${runs[1].name}`), h("div", { class: "filters" }, sides, which, module, search), count,
      h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Episodes" }, h("table", {}, h("thead", {}, h("tr", {}, head)), body))],
    ready: fill,
  };
}

// Two episodes on one clock and one road: the second as the dashed outline. A run without an evaluation has no episode.
export async function besidePage(query, ...names) {
  const bases = [0, 2].map((at) => `/api/runs/${names[at]}` + (names[at + 1] === null ? "" : `/episodes/${encodeURIComponent(names[at + 1])}`));
  const runs = await Promise.all(bases.map((base) => ask(base)));
  const steps = await Promise.all(bases.map(async (base) => (await ask(`${base}/steps?skip=0`)).steps));
  const road = new RoadRecord();
  road.add((await ask(`${bases[0]}/road?skip=0`)).lines);
  road.baseline = runs[1].path.map((one) => [one.at_s, one.x_m, one.y_m, one.heading_deg, one.speed_kmh / 3.6]);
  const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "The road of the first episode, with the car of the second as a dashed outline" });
  const view = new RoadView(canvas, road, () => {});
  const [begin, end] = [Math.min(0, road.begin), Math.max(road.end, ...steps.map((each) => each.at(-1)?.at_s ?? 0))];
  const slider = h("input", { type: "range", min: begin, max: end, step: 0.1, "aria-label": "Time in both drives" });
  const clock = h("output", { class: "clock" });
  const columns = runs.map((run, index) => side(run, steps[index], bases[index], (to) => jump(to)));

  function jump(to) {
    const at = Math.min(end, Math.max(begin, to));
    slider.value = at;
    slider.setAttribute("aria-valuetext", `${seconds(at)} from the hand-over`);
    clock.textContent = seconds(at);
    view.draw(at);
    for (const each of columns) each.show(at);
    history.replaceState(null, "", `#/beside/${names.filter((name) => name !== null).map(encodeURIComponent).join("/")}?at=${Math.round(at * 10) / 10}`);
  }
  slider.addEventListener("input", () => jump(Number(slider.value)));
  const instants = [...new Set(steps.flat().map((each) => each.at_s))].sort((a, b) => a - b);
  const hop = (by) => jump((by > 0 ? instants.find((each) => each > Number(slider.value) + 0.05) : instants.findLast((each) => each < Number(slider.value) - 0.05)) ?? Number(slider.value));
  const button = (words, by) => h("button", { type: "button", onclick: () => hop(by) }, words);
  return {
    title: `${runs[0].task}, two runs`,
    content: [h("h1", {}, runs[0].task), h("p", { class: "said" }, `“${runs[0].goal}”`),
      h("div", { class: "card transport" }, button("‹ Step", -1), button("Step ›", 1), h("div", { class: "time-line" }, slider), clock),
      h("div", { class: "pair" }, columns.map((each) => each.element)),
      h("figure", { class: "card map alone" }, canvas, h("figcaption", { class: "muted" }, "The first episode's road; dashed, the car of the second."))],
    ready: () => jump(Number(query.get("at")) || 0),
    leave: () => view.leave(),
  };
}

function side(run, steps, base, jump) {
  const screen = h("img", { class: "screen", alt: "" });
  const empty = h("p", { class: "muted empty" }, "No picture of this screen was kept.");
  const list = h("ol", { class: "steps" }, steps.map((each) => h("li", {}, h("button", { type: "button", onclick: () => jump(each.at_s) }, h("span", { class: "time" }, seconds(each.at_s)), h("span", {}, `${each.number ? `${each.number}  ` : ""}${each.words}`)))));
  const said = h("p", { class: "muted" });
  const parts = Object.entries(run.verdict?.parts ?? {}).filter(([, part]) => !part.ok).map(([name, part]) => `${run.parts[name] ?? plain(name)}: ${part.why}`);
  return {
    element: h("section", {}, h("h2", {}, [run.agent, run.model !== "none" && modelName(run.model), ...(run.conditions ?? [])].filter(Boolean).join(" · "), " ", outcome(run)),
      h("div", { class: "card stage-one" }, h("div", { class: "frame" }, screen, empty)), said, h("div", { class: "card" }, list),
      parts.length ? h("p", { class: "muted" }, parts.join("; ")) : null),
    show(at) {
      const index = steps.findLastIndex((each) => each.at_s <= at + 1e-6);
      const now = steps[index];
      [...list.querySelectorAll("button")].forEach((each, place) => (place === index ? each.setAttribute("aria-current", "step") : each.removeAttribute("aria-current")));
      screen.hidden = !now?.has_picture;
      empty.hidden = !screen.hidden;
      if (now?.has_picture) {
        screen.src = `${base}/pictures/${now.picture}`;
        screen.alt = `The cockpit's screen after step ${now.number}: ${now.words}`;
      }
      said.textContent = now ? [now.thought, now.feedback.text].filter(Boolean).join(" · ") || " " : "Before the hand-over: no agent acts yet.";
    },
  };
}
