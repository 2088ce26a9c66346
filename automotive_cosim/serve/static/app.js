// Which page an address shows. Everything after # stays in the browser, so links outlive the server.

import { h } from "./dom.js";
import { runsPage, resultsPage } from "./runs.js";
import { replayPage } from "./replay.js";
import { playPage } from "./play.js";
import { scenariosPage, taskPage, tasksPage } from "./browse.js";

const PAGES = [
  [/^\/?$/, runsPage],
  [/^\/results\/([0-9a-f]{12})$/, resultsPage],
  [/^\/run\/([0-9a-f]{12})(?:\/([^/]+))?$/, replayPage],
  [/^\/tasks$/, tasksPage],
  [/^\/tasks\/([\w-]+)$/, taskPage],
  [/^\/scenarios$/, scenariosPage],
  [/^\/play$/, playPage],
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
  const top = ["/tasks", "/scenarios", "/play"].find((page) => path.startsWith(page)) ?? "/";
  for (const link of document.querySelectorAll("nav a")) {
    if (link.getAttribute("href") === `#${top}`) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

addEventListener("hashchange", show);
show();
