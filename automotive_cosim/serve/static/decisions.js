// A study's decisions, and the routes of the futures of one of them on a map.

import { ask, counted, h, svg } from "./dom.js";

const MOST = 400;
const EVERY_MS = 3000;
const WAYS = ["keeps its route", ...Array.from({ length: 20 }, (_, index) => `alternative ${index + 1}`)];
const signed = (value, unit) => `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value)} ${unit}`;
const wayOf = (branch) => WAYS[branch === null ? 0 : branch + 1];

export async function decisionsPage(query, id) {
  let study = await ask(`/api/studies/${id}`);
  const trips = [...new Set(study.decisions.map(({ trip }) => trip))].sort();
  const trip = h("select", { "aria-label": "Trip" }, h("option", { value: "" }, "Trip: all"), trips.map((name) => h("option", { value: name, selected: name === query.get("trip") }, name)));
  const which = h("select", { "aria-label": "Which decisions" }, [["", "all decisions"], ["better", "another route saves time"], ["worse", "no other route saves time"], ["excluded", "excluded ones"]].map(([value, words]) => h("option", { value, selected: value === query.get("show") }, words)));
  const count = h("p", { class: "muted", role: "status" });
  const body = h("tbody");
  const best = (each) => each.futures.reduce((most, future) => (!most || future.gain_s > most.gain_s ? future : most), null);

  function fill() {
    const kept = study.decisions.filter((each) => (!trip.value || each.trip === trip.value)
      && (!which.value || (which.value === "excluded" ? each.excluded : !each.excluded && (best(each)?.gain_s > 0) === (which.value === "better"))));
    count.textContent = `${counted(kept.length, "decision")} of ${study.decisions.length}, from ${study.done} of ${study.planned} drives`;
    body.replaceChildren(...kept.slice(0, MOST).map((each) => h("tr", {},
      h("td", {}, h("a", { href: `#/decision/${id}/${encodeURIComponent(each.id)}` }, each.trip)), h("td", {}, String(each.seed)), h("td", {}, `${Math.round(each.at_s)} s`), h("td", {}, `${Math.round(each.delay_s)} s`),
      h("td", {}, best(each) ? `${signed(best(each).gain_s, "s")} (${wayOf(best(each).number)})` : ""), h("td", {}, best(each) ? signed(best(each).others_s, "s") : ""), h("td", {}, each.excluded))));
    const kept_ = new URLSearchParams();
    if (trip.value) kept_.set("trip", trip.value);
    if (which.value) kept_.set("show", which.value);
    history.replaceState(null, "", `#/decisions/${id}${kept_.size ? `?${kept_}` : ""}`);
  }
  for (const each of [trip, which]) each.addEventListener("change", fill);
  const live = h("p", { hidden: !study.running }, h("a", { class: "pill live", href: `#/live/${id}` }, "Watch live"));
  const again = async () => {
    if (!study.running) return;
    study = await ask(`/api/studies/${id}`);
    live.hidden = !study.running;
    fill();
  };
  const timer = setInterval(() => again().catch(() => {}), EVERY_MS);
  return {
    title: study.name,
    content: [h("h1", {}, study.name), h("p", { class: "muted" }, `A study in ${study.scenario}: at each decision the drive is copied, and every route is driven to its end. Delay ahead: how much longer the rest of the route takes at present speeds than at the limits.`), live, h("div", { class: "filters" }, trip, which), count,
      h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Decisions" }, h("table", {},
        h("thead", {}, h("tr", {}, ["Trip", "Seed", "At", "Delay ahead", "Best alternative saves", "Other vehicles save", "Excluded"].map((name) => h("th", { scope: "col" }, name)))), body))],
    ready: fill,
    leave: () => clearInterval(timer),
  };
}

export async function decisionPage(query, id, name) {
  const study = await ask(`/api/studies/${id}`);
  const found = study.decisions.find((each) => each.id === name);
  if (!found) throw new Error("There is no such decision.");
  const map = found.has_ways ? await ask(`/api/studies/${id}/decisions/${encodeURIComponent(name)}`) : null;
  const rows = [{ number: null, gain_s: 0, stops: 0, distance_m: 0, co2_g: 0, others_s: 0, changed: 0 }, ...found.futures];
  const chosen = (number) => [...new Set(found.choices.filter(({ branch }) => branch === number).map(({ policy }) => policy))].join(", ");
  const picture = map && drawn(map);
  const moving = picture && map.tracks.some((track) => track.length) ? cursor(picture, map) : null;
  return {
    title: `${found.trip} at ${Math.round(found.at_s)} s`,
    content: [h("h1", {}, `${found.trip} at ${Math.round(found.at_s)} s`),
      h("p", { class: "muted" }, h("a", { href: `#/decisions/${id}` }, study.name), ` · seed ${found.seed} · ${Math.round(found.delay_s)} s of delay ahead, ${Math.round(found.eta_s)} s to the destination${found.draws > 1 ? ` · mean of ${found.draws} runs` : ""}${found.complies ? "" : " · the driver would not comply"}`),
      found.told.length > 0 && h("p", {}, found.told.join(" ")),
      found.excluded && h("p", { class: "warning" }, `Excluded: ${found.excluded}. ${found.why}`),
      map ? h("figure", { class: "card ways" }, picture, moving?.element, h("figcaption", {}, h("span", {}, h("i", { class: "key here" }), "decides here"), map.ways.map((_, index) => h("span", {}, h("i", { class: `key way-${index}` }), WAYS[index])))) : h("p", { class: "card" }, "This study was made before routes were recorded."),
      h("div", { class: "card scroll", tabindex: 0, role: "region", "aria-label": "Routes" }, h("table", {},
        h("thead", {}, h("tr", {}, ["Route", "Saves", "Stops saved", "Distance saved", "CO₂ saved", "Other vehicles save", "Others affected", "Chosen by"].map((each) => h("th", { scope: "col" }, each)))),
        h("tbody", {}, rows.map((each) => h("tr", {}, h("td", {}, wayOf(each.number)), h("td", {}, signed(each.gain_s, "s")), h("td", {}, signed(each.stops, "")), h("td", {}, signed(each.distance_m, "m")), h("td", {}, signed(each.co2_g, "g")), h("td", {}, signed(each.others_s, "s")), h("td", {}, String(each.changed)), h("td", {}, chosen(each.number))))))),
    ].filter(Boolean),
    leave: () => moving?.stop(),
  };
}

// The cars of all futures at one instant, with a slider and a button that lets time run.
function cursor(picture, { box: [left, , , top], tracks }) {
  const end = Math.max(...tracks.map((track) => track.at(-1)?.[0] ?? 0));
  const size = picture.viewBox.baseVal.width / 90;
  // where cars overlap, each is visible around the next
  const cars = tracks.map((_, index) => svg("circle", { r: size * Math.max(0.6, 1.4 - 0.35 * index), class: `car way-${index}` }));
  picture.append(...cars);
  const slider = h("input", { type: "range", min: 0, max: end, step: 1, value: 0, "aria-label": "Seconds since the decision" });
  const told = h("p", { class: "muted", role: "status" });
  const run = h("button", { type: "button", class: "main" }, "Play");
  let timer = 0;
  const show = () => {
    const at = Number(slider.value);
    tracks.forEach((track, index) => {
      const place = track.findLast(([when]) => when <= at + 0.01);
      cars[index].style.visibility = place ? "visible" : "hidden";
      if (place) { cars[index].setAttribute("cx", place[1] - left); cars[index].setAttribute("cy", top - place[2]); }
    });
    told.textContent = [`+${at} s`, ...tracks.flatMap((track, index) => (track.length && track.at(-1)[0] <= at ? [`${WAYS[index]}: arrives after ${Math.round(track.at(-1)[0])} s`] : []))].join(" · ");
  };
  const stop = () => { clearInterval(timer); timer = 0; run.textContent = "Play"; };
  run.addEventListener("click", () => {
    if (timer) return stop();
    if (Number(slider.value) >= end) slider.value = 0;
    run.textContent = "Pause";
    timer = setInterval(() => { slider.value = Math.min(end, Number(slider.value) + 1); show(); if (Number(slider.value) >= end) stop(); }, 100);
  });
  slider.addEventListener("input", show);
  show();
  return { element: h("div", { class: "transport" }, run, h("div", { class: "time-line" }, slider), told), stop };
}

// The surrounding roads, each route in its own colour and thinner than the one before, so that both show where they coincide, and a dot at the decision.
function drawn({ box: [left, bottom, right, top], roads, ways }) {
  const points = (flat) => Array.from({ length: flat.length / 2 }, (_, index) => `${flat[2 * index] - left},${top - flat[2 * index + 1]}`).join(" ");
  const size = Math.max(right - left, top - bottom);
  const root = svg("svg", { viewBox: `0 0 ${right - left} ${top - bottom}`, role: "img", "aria-label": `The current route and ${ways.length - 1} other routes from the same place`, preserveAspectRatio: "xMidYMid meet" });
  root.append(...roads.map((road) => svg("polyline", { points: points(road), class: "street", "stroke-width": size / 400 })));
  root.append(...ways.map((way, index) => svg("polyline", { points: points(way), class: `way way-${index}`, "stroke-width": size / (80 * 1.5 ** Math.min(index, 3)) })));
  if (ways[0].length) root.append(svg("circle", { cx: ways[0][0] - left, cy: top - ways[0][1], r: size / 70, class: "here" }));
  return root;
}
