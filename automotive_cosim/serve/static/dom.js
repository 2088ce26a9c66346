// Builds elements. The contents of records are only set as text, never as markup.

export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "class") element.className = value;
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

export function svg(tag, properties = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(properties)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

export const plain = (name) => String(name ?? "").replaceAll("_", " ");

// The model's name as people read it: without prices, which change nothing that it does.
export function modelName(model) {
  const [name, options = ""] = (model ?? "").split("?"); // nothing is known of an episode that has just begun
  return [name, ...options.split("&").filter((each) => each && !each.startsWith("usd_per_"))].join(", ");
}

export const counted = (count, name) => `${count} ${name}${count === 1 ? "" : "s"}`;

export function seconds(value) {
  const rounded = Math.round(value * 10) / 10;
  return `${rounded < 0 ? "−" : "+"}${Math.abs(rounded).toFixed(rounded % 1 ? 1 : 0)} s`;
}

const KM_PER_MILE = 1.609344;

// Speeds are recorded in km/h, with the unit of the signs where they were driven; older records have none.
export const kmhPerUnit = (unit) => (unit === "mph" ? KM_PER_MILE : 1);

export const speedInWords = (kmh, unit) => `${Math.round(kmh / kmhPerUnit(unit))} ${unit ?? "km/h"}`;

export function outcome(record) {
  if (record.running) return h("span", { class: "pill live" }, "Running");
  if (record.success === true) return h("span", { class: "pill good" }, "Success");
  if (record.success === false) return h("span", { class: "pill bad" }, "Not solved");
  return h("span", { class: "pill" }, record.error ? "Error" : plain(record.end) || "No verdict");
}

export async function ask(path) {
  return answered(path, { credentials: "same-origin" });
}

export async function send(path, value) {
  return answered(path, { method: "POST", credentials: "same-origin", body: JSON.stringify(value) });
}

// Answers with a picture, or with an object if it is none.
async function answered(path, request) {
  let answer;
  try {
    answer = await fetch(path, request);
  } catch {
    throw new Error("The server does not answer. Restart `automotive-cosim serve`.");
  }
  let body;
  try {
    if (answer.ok && answer.headers.get("Content-Type").startsWith("image/")) return await answer.blob();
    body = await answer.json();
  } catch {
    throw new Error(`The server's answer cannot be read (${answer.status}).`);
  }
  if (!answer.ok) throw new Error(body.error || `The server refused the request (${answer.status}).`);
  return body;
}
