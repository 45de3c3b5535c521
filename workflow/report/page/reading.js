"use strict";

// Light or dark: as the system has it, until the reader chooses.
const theme = document.getElementById("theme");
const system = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (document.documentElement.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
const press = () => theme.setAttribute("aria-pressed", String(isDark()));
press();
theme.hidden = false;
system.addEventListener("change", press);
theme.addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  press();
});

// The contents follow the reading: the last heading that has passed a line below the top.
const links = [...document.querySelectorAll("nav li > a")];
const places = links.map((link) => document.getElementById(link.hash.slice(1)));
function follow() {
  const passed = places.map((place) => place.getBoundingClientRect().top < 120);
  const current = links[Math.max(0, passed.lastIndexOf(true))];
  for (const link of links) link.classList.toggle("current", link === current);
  for (const item of document.querySelectorAll("nav > details > ul > li")) {
    item.classList.toggle("reading", item.contains(current));
  }
}
addEventListener("scroll", () => requestAnimationFrame(follow), { passive: true });
follow();
const contents = document.querySelector("nav > details");
const narrow = matchMedia("(max-width: 1279px)");
const fold = () => { contents.open = !narrow.matches; };
narrow.addEventListener("change", fold);
fold();
contents.addEventListener("click", (event) => {
  if (narrow.matches && event.target.closest("a")) contents.open = false;
});

// What an address leads to is unfolded: the details around it, and a table's own.
function unfold() {
  const place = document.getElementById(location.hash.slice(1));
  if (!place) return;
  for (let one = place; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true;
  if (place.firstElementChild?.tagName === "DETAILS") place.firstElementChild.open = true;
  place.scrollIntoView();
}
addEventListener("hashchange", unfold);
unfold();

// Claims of one verdict, or all of them.
const filter = document.querySelector(".filter");
if (filter) {
  filter.hidden = false;
  filter.addEventListener("click", (event) => {
    const chosen = event.target.closest("button");
    if (!chosen) return;
    for (const button of filter.children) {
      button.setAttribute("aria-pressed", String(button === chosen));
    }
    for (const card of document.querySelectorAll(".card")) {
      card.hidden = !["", card.dataset.verdict].includes(chosen.dataset.verdict);
    }
    const sources = document.querySelectorAll(".source");
    for (const source of sources) { // one alone stays open
      const found = chosen.dataset.verdict && source.querySelector(".card:not([hidden])");
      source.open = sources.length === 1 || Boolean(found);
    }
  });
}

// The viewer is a file beside this one, and starts when asked for, or by an address that has its state.
const figure = document.querySelector(".viewer");
if (figure) {
  const poster = figure.querySelector(".poster"), start = figure.querySelector(".poster a");
  const mark = "#viewer?";
  let asked = location.hash.startsWith(mark) ? location.hash.slice(mark.length) : "";
  start.addEventListener("click", (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return; // a tab of its own
    event.preventDefault();
    const frame = document.createElement("iframe");
    frame.title = "Viewer: drag the light";
    frame.src = start.getAttribute("href");
    poster.replaceWith(frame);
    frame.focus();
    addEventListener("message", ({ source, data }) => {
      if (source !== frame.contentWindow || typeof data?.viewer !== "string") return;
      if (asked) source.postMessage({ open: asked }, "*");
      else if (data.viewer) history.replaceState(null, "", mark + data.viewer);
      asked = "";
    });
  });
  if (asked) start.click();
}

// A picture is shown in its own size, and back.
for (const image of document.querySelectorAll("figure .scroll img")) {
  image.addEventListener("click", () => image.classList.toggle("whole"));
}

// What a chart's point says: under the pointer, or by the arrow keys when the chart is chosen.
const tip = document.getElementById("tip");
function say(point) {
  tip.hidden = !point;
  document.querySelector(".said")?.classList.remove("said");
  if (!point) return;
  point.classList.add("said");
  tip.textContent = point.dataset.says;
  const box = point.getBoundingClientRect();
  const left = box.left + box.width / 2 - tip.offsetWidth / 2;
  const right = document.documentElement.clientWidth - tip.offsetWidth - 4;
  tip.style.left = `${Math.max(4, Math.min(left, right))}px`;
  const above = box.top - tip.offsetHeight - 6;
  tip.style.top = `${scrollY + (above > 0 ? above : box.bottom + 6)}px`;
}
addEventListener("pointerdown", ({ target }) => {
  if (!target.closest(".chart")) say(null);
});
for (const chart of document.querySelectorAll(".chart")) {
  const points = [...chart.querySelectorAll(".says")];
  for (const point of points) {
    const title = point.querySelector("title");
    point.dataset.says = title.textContent;
    title.remove(); // or the browser shows it as well
  }
  let at = -1;
  chart.addEventListener("pointerover", (event) => say(event.target.closest(".says")));
  chart.addEventListener("pointerleave", ({ pointerType }) => {
    if (pointerType !== "touch") say(null); // a finger that lifts leaves, too
  });
  chart.addEventListener("blur", () => say(null));
  chart.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !points.length) return;
    const from = Math.max(at, step < 0 ? 0 : -1); // at first the left key goes to the last
    at = (from + step + points.length) % points.length;
    points[at].scrollIntoView({ block: "nearest", inline: "nearest" });
    say(points[at]);
    event.preventDefault();
  });
}
