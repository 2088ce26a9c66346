// Which page an address shows. Everything after # stays in the browser, so links outlive the server.

import { ask, h } from "./dom.js";
import { runsPage, resultsPage } from "./runs.js";
import { livePage } from "./live.js";
import { replayPage } from "./replay.js";
import { playPage } from "./play.js";
import { besidePage, comparePage } from "./compare.js";
import { fleetPage } from "./fleet.js";
import { decisionPage, decisionsPage } from "./decisions.js";
import { studyPage } from "./study.js";
import { scenariosPage, taskPage, tasksPage } from "./browse.js";

const PAGES = [
  [/^\/?$/, runsPage],
  [/^\/results\/([0-9a-f]{12})$/, resultsPage],
  [/^\/run\/([0-9a-f]{12})(?:\/([^/]+))?$/, replayPage],
  [/^\/tasks$/, tasksPage],
  [/^\/tasks\/([\w-]+)$/, taskPage],
  [/^\/scenarios$/, scenariosPage],
  [/^\/play$/, playPage],
  [/^\/study$/, studyPage],
  [/^\/live\/([0-9a-f]{12})$/, livePage],
  [/^\/decisions\/([0-9a-f]{12})$/, decisionsPage],
  [/^\/fleet\/([0-9a-f]{12})(?:\/([^/]+))?(?:\/([^/]+))?$/, fleetPage],
  [/^\/decision\/([0-9a-f]{12})\/([^/]+)$/, decisionPage],
  [/^\/compare\/([0-9a-f]{12})\/([0-9a-f]{12})$/, comparePage],
  [/^\/beside\/([0-9a-f]{12})\/([^/]+)\/([0-9a-f]{12})\/([^/]+)$/, besidePage],
  [/^\/beside\/([0-9a-f]{12})\/([0-9a-f]{12})$/, (query, one, other) => besidePage(query, one, null, other, null)],
];

let leave = null;
let shown = 0;

async function show() {
  const ticket = ++shown;
  const [path, query = ""] = location.hash.slice(1).split("?");
  if (path === "main") return;
  leave?.();
  leave = null;
  const main = document.getElementById("main");
  main.replaceChildren(h("p", { class: "muted" }, "Loading …"));
  mark(path);
  try {
    const found = PAGES.map(([pattern, page]) => [path.match(pattern), page]).find(([match]) => match);
    if (!found) throw new Error("There is no such page.");
    const parts = found[0].slice(1).map((part) => part && decodeURIComponent(part));
    const page = await found[1](new URLSearchParams(query), ...parts);
    if (ticket !== shown) return page.leave?.();
    document.title = `${page.title} · automotive-cosim`;
    main.replaceChildren(...page.content);
    leave = page.leave ?? null;
    page.ready?.();
  } catch (error) {
    if (ticket !== shown) return;
    main.replaceChildren(h("h1", {}, "This cannot be shown"), h("p", { class: "warning", role: "alert" }, error.message));
  }
}

function mark(path) {
  const top = ["/tasks", "/scenarios", "/play", "/study"].find((page) => path.startsWith(page)) ?? "/";
  for (const link of document.querySelectorAll("nav a")) {
    if (link.getAttribute("href") === `#${top}`) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

// A participant in a study sees nothing else.
async function greet() {
  const { study, visitor } = await ask("/api/about");
  for (const link of document.querySelectorAll("nav a")) {
    const isStudy = link.getAttribute("href") === "#/study";
    link.hidden = isStudy ? !study : visitor !== "owner";
  }
  if (visitor !== "owner") {
    document.querySelector(".brand").setAttribute("href", "#/study");
    if (location.hash !== "#/study") location.hash = "#/study";
  }
}

addEventListener("hashchange", show);
greet().catch(() => {}).then(show);
