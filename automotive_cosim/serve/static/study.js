// A study: a person takes a seat under a code name, plays the dealt episodes, and answers questions after each.

import { ask, h, plain, send } from "./dom.js";
import { cockpitPanel, listen, rulesCard, waiting } from "./cockpit.js";
import { detector } from "./detection.js";

const KEPT = "automotive-cosim seat"; // in this tab: a second tab is another person

export async function studyPage() {
  const { visitor } = await ask("/api/about");
  const study = await ask("/api/study");
  const main = h("div");
  const note = h("p", { class: "warning", hidden: true, role: "alert" });
  const status = h("p", { class: "muted", role: "status" });
  const heading = h("h1", {}, "Study");
  const say = (error) => { note.textContent = error?.message ?? ""; note.hidden = !error; };
  const trying = (what) => async (event) => { event?.preventDefault(); try { say(null); await what(event); } catch (error) { say(error); } };
  let seat = sessionStorage.getItem(KEPT) ?? "";
  let [stop, cockpit, turn, gone] = [() => {}, null, null, false];
  const detection = study.detection && detector(study.detection, (came) => send(at("detected"), came).catch(say));
  const detecting = h("div", { hidden: true }, detection?.element);
  const detect = (phase) => { detecting.hidden = !phase; detection?.during(phase); };

  const at = (what) => `/api/study/${what}?${new URLSearchParams({ seat })}`;

  async function welcome(people) {
    status.textContent = "";
    const name = h("select", { required: true }, h("option", { value: "" }, "Choose"), people.map((each) => h("option", { value: each.name }, each.name)));
    const seen = visitor === "owner" && study.detection ? await ask("/api/study/seen") : {};
    main.replaceChildren(h("form", { class: "card filters", onsubmit: trying(async () => {
      ({ seat } = await send("/api/study/join", { name: name.value, seat }));
      sessionStorage.setItem(KEPT, seat);
      await sitDown();
    }) }, h("label", {}, "Your code name", name), h("button", { type: "submit", class: "main" }, "Take part")), rulesCard(), ...(visitor === "owner" ? [owners(people, seen)] : []));
  }

  function owners(people, seen) {
    return h("section", {}, h("h2", {}, "Everyone's progress"), h("div", { class: "card" },
      h("ul", {}, people.map((each) => h("li", {}, `${each.name}: ${each.done} of ${each.planned}`))),
      study.detection && h("table", {}, h("thead", {}, h("tr", {}, ["Red dots", "Phase", "Seen", "Reaction"].map((name) => h("th", { scope: "col" }, name)))),
        h("tbody", {}, Object.entries(seen).flatMap(([name, phases]) => Object.entries(phases).map(([phase, each]) => h("tr", {}, h("td", {}, name), h("td", {}, phase), h("td", {}, `${each.hits} of ${each.stimuli}`), h("td", {}, each.reaction_ms === null ? "" : `${Math.round(each.reaction_ms)} ms`)))))),
      h("p", { class: "muted" }, "Rows, answers and times: ", h("a", { href: "/api/study/rows.csv", download: "study.csv" }, "CSV"), " · ", h("a", { href: "/api/study/rows.json", download: "study.json" }, "JSON"))));
  }

  async function sitDown() {
    turn = await ask(at("seat"));
    heading.textContent = `Study · ${turn.person}`;
    cockpit?.leave();
    stop();
    cockpit = cockpitPanel({ base: "/api/study/play", query: { seat }, say, leaveLabel: "Give up" });
    stop = listen({ base: "/api/study/play", query: { seat }, say, changed: trying2(show) });
  }

  const trying2 = (what) => (scene) => what(scene).catch(say);

  async function show(scene) {
    detect({ acting: "task", driving: "rest" }[scene.state] ?? "");
    if (scene.state === "acting") {
      if (main.firstChild !== cockpit.element) main.replaceChildren(cockpit.element);
      cockpit.show(scene);
      status.textContent = "";
      return;
    }
    cockpit.hide();
    if (["warming", "driving", "ending"].includes(scene.state)) {
      const [text, bar] = waiting(scene);
      status.textContent = text;
      main.replaceChildren(...[bar, rulesCard()].filter(Boolean));
      return;
    }
    turn = await ask(at("seat"));
    if (gone) return;
    status.textContent = `${turn.done} of ${turn.planned} episodes done.${scene.state === "failed" ? " The last one could not be judged, through no fault of yours." : ""}`;
    if (turn.phase === "ask") main.replaceChildren(questions(scene));
    else if (turn.phase === "play") main.replaceChildren(h("form", { class: "card filters", onsubmit: trying(() => send(at("begin"), {})) }, h("p", {}, "When you begin, the car drives to the place where the driver says something. From then on, the clock runs."), h("button", { type: "submit", class: "main" }, "Begin the next episode")), rulesCard());
    else main.replaceChildren(...verdicts());
  }

  function questions(scene) {
    return h("form", { class: "card questions", onsubmit: trying(async (event) => {
      const given = new FormData(event.target);
      await send(at("answer"), Object.fromEntries(study.questions.map(({ name }) => [name, Number(given.get(name))])));
      await show(scene);
    }) }, h("h2", {}, "About what you just did"), study.questions.map(({ name, text }) => h("fieldset", {}, h("legend", {}, text),
      h("div", { class: "scale" }, study.scale.map((words, index) => h("label", {}, h("input", { type: "radio", name, value: index + 1, required: true }), words))))),
    h("button", { type: "submit", class: "main" }, "Continue"));
  }

  function verdicts() {
    const said = (each) => (each.success ? "✓ success" : each.success === false ? `✗ not solved: ${each.missing.map(plain).join(", ")}` : "no verdict");
    return [h("p", { class: "card said" }, "That was the last one. Thank you!"), h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Your verdicts" }, h("table", {},
      h("thead", {}, h("tr", {}, ["Task", "Half", "Verdict"].map((name) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, turn.verdicts.map((each) => h("tr", {}, h("td", {}, each.task), h("td", {}, each.half), h("td", {}, said(each)))))))];
  }

  return {
    title: "Study",
    content: [heading, note, status, detecting, main],
    ready: async () => {
      if (!seat) return welcome(study.people);
      try { await sitDown(); } catch { welcome(study.people); }
    },
    leave: () => { gone = true; stop(); cockpit?.leave(); detection?.leave(); },
  };
}
