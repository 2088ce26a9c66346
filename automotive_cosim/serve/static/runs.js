// The list of records, and the table of an evaluation's episodes.

import { ask, counted, h, modelName, outcome, plain, seconds } from "./dom.js";

const EVERY_MS = 3000;

export async function runsPage() {
  const list = h("ul", { class: "records" });
  const note = h("p", { class: "muted" });
  const fill = async () => {
    const { records } = await ask("/api/runs");
    list.replaceChildren(...records.filter((record) => record.kind !== "other").map((record) => line(record, records)));
    note.textContent = records.length ? "" : "Nothing recorded yet. `automotive-cosim run` records an episode.";
  };
  await fill();
  const timer = setInterval(() => fill().catch((error) => { note.textContent = error.message; }), EVERY_MS);
  return { title: "Runs", content: [h("h1", {}, "Runs"), note, list], leave: () => clearInterval(timer) };
}

const WHOLE = { evaluation: ["results", "Evaluation", "episode"], drives: ["results", "Evaluation of drives", "drive"], study: ["decisions", "Study"] };

function line(record, records) {
  if (record.kind === "unreadable") {
    return h("li", { class: "card" }, h("div", {}, h("b", {}, record.name), h("p", { class: "muted" }, record.error)),
      h("span", { class: "pill bad" }, "Unreadable"));
  }
  if (WHOLE[record.kind]) {
    const [, whole, unit = record.unit] = WHOLE[record.kind];
    const page = record.study === "adoption" ? "fleet" : WHOLE[record.kind][0];
    const label = record.is_search ? "Search" : record.seeds ? `${whole} of ${counted(record.seeds, "seed")}` : whole;
    const done = record.planned ? `${record.done} of ${counted(record.planned, unit)}` : counted(record.done, unit);
    return h("li", { class: "card" },
      h("div", {}, h("a", { href: `#/${page}/${record.id}` }, record.name), h("p", { class: "muted" }, `${label} · ${done} · ${when(record.started)}`)),
      record.running && record.kind === "study" ? h("a", { class: "pill live", href: `#/${page === "fleet" ? page : "live"}/${record.id}` }, "Watch live")
        : record.is_search && !record.running ? h("a", { class: "pill quiet", href: findings(record.id) }, "Findings")
        : h("span", { class: record.running ? "pill live" : "pill quiet" }, record.running ? "Running" : "Results"));
  }
  const about = [record.half && `${record.half} half`, record.scenario, record.agent, record.model !== "none" && modelName(record.model), record.seed !== null && `seed ${record.seed}`, ...(record.conditions ?? []), when(record.started)];
  return h("li", { class: "card" },
    h("div", {}, h("a", { href: `#/run/${record.id}` }, record.task), " ",
      records.some((each) => each.id === record.beside) && h("a", { class: "pill quiet", href: `#/beside/${record.id}/${record.beside}` }, "Beside the same without its place"),
      record.goal && h("p", {}, `“${record.goal}”`),
      h("p", { class: "muted" }, about.filter(Boolean).join(" · "))),
    record.kind === "drive" && !record.running && record.value !== null ? h("span", { class: "pill quiet" }, `Score ${Math.round(record.value)}`) : outcome(record));
}

const findings = (id) => `/api/evaluations/${id}/search.html`;
const searched = (results) => results.is_search ? h("p", {}, "These are the runs of a search. ", h("a", { href: findings(results.id) }, "What it found")) : "";

const when = (text) => (text ? text.slice(0, 16).replace("T", " ") : "");

const FILTERS = [["agent", "Agent"], ["scenario", "Scenario"], ["module", "Module"], ["missing", "Failed part"], ["outcome", "Outcome"]];
const MOST = 400;

export async function resultsPage(query, id) {
  let results = await ask(`/api/evaluations/${id}`);
  if (results.kind === "drives") return drivesPage(id, results);
  const heading = h("p", { class: "muted" });
  const now = h("p");
  const table = h("tbody");
  const count = h("p", { class: "muted", role: "status" });
  const search = h("input", { type: "search", "aria-label": "Search for a task or an episode", placeholder: "Search tasks", value: query.get("q") ?? "" });
  const choices = FILTERS.map(([name, label]) => h("select", { name, "aria-label": label }));

  const values = (row, name) => {
    if (name === "missing") return row.missing.map(plain);
    if (name === "outcome") return [row.success === true ? "success" : row.success === false ? "not solved" : "error"];
    return [String(row[name])];
  };
  const options = () => FILTERS.forEach(([name, label], index) => {
    const chosen = choices[index].value || query.get(name) || "";
    const found = [...new Set(results.rows.flatMap((row) => values(row, name)))].sort();
    choices[index].replaceChildren(h("option", { value: "" }, `${label}: all`), ...found.map((value) => h("option", { value, selected: value === chosen }, value)));
  });
  const fill = () => {
    const kept = results.rows.filter((row) =>
      FILTERS.every(([name], index) => !choices[index].value || values(row, name).includes(choices[index].value))
      && `${row.task} ${row.id}`.toLowerCase().includes(search.value.toLowerCase()));
    const judged = kept.filter((row) => row.success !== null);
    const won = judged.filter((row) => row.success).length;
    count.textContent = `${counted(kept.length, "episode")}, ${won} of ${judged.length} judged succeeded`
      + (kept.length > MOST ? `; the first ${MOST} are listed` : "");
    table.replaceChildren(...inPairs(kept.slice(0, MOST)).map((rows) => episodes(id, rows)));
    heading.textContent = results.planned ? `${results.rows.length} of ${results.planned} episodes done` : counted(results.rows.length, "episode");
    now.replaceChildren(...(results.running.length ? ["Running now: ", ...results.running.flatMap((one) => [h("a", { href: `#/run/${id}/${encodeURIComponent(one)}` }, one), " "])] : []));
    const parameters = new URLSearchParams();
    FILTERS.forEach(([name], index) => choices[index].value && parameters.set(name, choices[index].value));
    if (search.value) parameters.set("q", search.value);
    const text = parameters.toString();
    history.replaceState(null, "", `#/results/${id}${text ? `?${text}` : ""}`);
  };
  options();
  search.addEventListener("input", fill);
  choices.forEach((choice) => choice.addEventListener("change", fill));
  const again = async () => {
    if (results.planned && results.rows.length >= results.planned) return;
    results = await ask(`/api/evaluations/${id}`);
    options();
    fill();
  };
  const timer = setInterval(() => again().catch(() => {}), EVERY_MS);
  const { records } = await ask("/api/runs");
  const others = records.filter((record) => record.kind === "evaluation");
  const beside = h("select", { "aria-label": "Compare with", onchange: () => { if (beside.value) location.hash = `#/compare/${id}/${beside.value}`; } },
    h("option", { value: "" }, "Compare with …"), others.map((record) => h("option", { value: record.id }, record.id === id ? "itself: two of its agents" : record.name)));
  const head = ["Task", "Scenario", "Agent", "Seed", "Steps", "Outcome", "Failed parts"].map((name) => h("th", { scope: "col" }, name));
  return {
    title: results.name,
    content: [h("h1", {}, results.name), searched(results), heading, now, h("div", { class: "filters" }, search, choices, beside), count,
      h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Episodes" }, h("table", {}, h("thead", {}, h("tr", {}, head)), table)),
      results.drives?.length ? [h("h2", {}, "Drives"), drivesTable(id, results.drives)] : []].flat(),
    leave: () => clearInterval(timer),
    ready: fill,
  };
}

function drivesTable(id, rows) {
  const head = ["Drive", "Seed", "Agent", "Score", "Events met", "Nuisances", "Steps", ""].map((name) => h("th", { scope: "col" }, name));
  const figure = (value) => (value === null ? "" : String(Math.round(value)));
  return h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Drives" }, h("table", {}, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows.map((row) => h("tr", {},
    h("td", {}, row.has_road ? h("a", { href: `#/run/${id}/${encodeURIComponent(row.id)}` }, row.name) : row.name), h("td", {}, `${row.seed}${row.repeat ? ` · ${row.repeat + 1}` : ""}`), h("td", {}, [row.agent, row.model !== "none" && modelName(row.model), ...row.conditions].filter(Boolean).join(", ")),
    h("td", {}, figure(row.value)), h("td", {}, row.events === null ? "" : `${row.met} of ${row.events}`), h("td", {}, figure(row.nuisances)), h("td", {}, String(row.steps)), h("td", { class: "muted" }, row.error ? `${row.error_kind}: ${row.error}` : plain(row.end)))))));
}

function drivesPage(id, results) {
  const done = results.planned ? `${results.rows.length} of ${counted(results.planned, "drive")} are done` : counted(results.rows.length, "drive");
  return { title: results.name, content: [h("h1", {}, results.name), searched(results), h("p", { class: "muted" }, done), results.fleets.length ? h("p", {}, h("a", { class: "pill live", href: `#/fleet/${id}` }, "All cars on one map")) : "", drivesTable(id, results.rows)] };
}

// The halves of a pair stand in one row, first before second.
function inPairs(rows) {
  const found = new Map();
  for (const row of rows) {
    const key = [row.task, row.agent, row.model, row.seed, row.repeat, ...row.conditions].join(" ");
    found.set(key, [...(found.get(key) ?? []), row].sort((one, other) => (one.half < other.half ? -1 : 1)));
  }
  return [...found.values()];
}

function episodes(id, rows) {
  const [row] = rows;
  const each = (told) => rows.flatMap((one, index) => [index ? " · " : "", told(one)]);
  const agent = row.model === "none" || row.model === "rules" ? row.agent : `${row.agent} (${modelName(row.model)})`;
  const named = (one) => (row.pair ? `${one.half} ` : "");
  const why = (one) => (one.error ? `${one.error_kind}: ${one.error}` : one.missing.map(plain).join(", "));
  const shown = (one) => (one.has_trace ? h("a", { href: `#/run/${id}/${encodeURIComponent(one.id)}` }, named(one), outcome(one)) : h("span", {}, named(one), outcome(one)));
  return h("tr", {}, h("td", {}, row.task), h("td", {}, [...new Set(rows.map((one) => one.scenario))].join(" · ")),
    h("td", {}, [agent, ...row.conditions].join(", ")), h("td", {}, String(row.seed)),
    h("td", { title: rows.map((one) => seconds(one.sim_seconds)).join(" · ") }, rows.map((one) => one.steps).join(" · ")),
    h("td", {}, each(shown)), h("td", { class: "muted" }, rows.map((one) => why(one) && named(one) + why(one)).filter(Boolean).join(" · ")));
}
