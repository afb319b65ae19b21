// The studio's own part of the page. The server speaks to it through viser's local storage, under the key below, and it
// speaks to the server through an input that is not seen.
"use strict";
(() => {
  const KEY = "tmd-page", EVENT = "tmdevent", LOOK = 1500, PATIENCE = 12000;
  const SENT = 55, BUSY = 3000, SOON = 15; // milliseconds
  const getItem = Storage.prototype.getItem, setItem = Storage.prototype.setItem;
  const mine = (key) => String(key).endsWith(KEY);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let number = 0, recent = [];

  // what the server asks this window for, and tells it
  Storage.prototype.getItem = function (key) {
    if (!mine(key)) return getItem.call(this, key);
    recent = []; // the studio begins anew with this window
    return JSON.stringify({ search: location.search, dark: dark.matches });
  };
  Storage.prototype.setItem = function (key, value) {
    if (!mine(key)) return setItem.call(this, key, value);
    const told = JSON.parse(value);
    if (told.link !== undefined) history.replaceState(null, "", told.link || location.pathname);
    if (told.tab) tab(told.tab, 40);
  };

  // Of what happens in the panel viser sends something every 50 ms at most, and of what happens meanwhile the last thing
  // only. So a click waits until what was typed before it is sent, and what this script has to tell waits as well.
  let holding = 0, since = 0, last = null, unsent = null;
  const later = [], again = new Set();

  function hold() { // two timers, each a little longer than viser's: it may send once more after 50 ms
    since = performance.now();
    wait(2);
  }

  function wait(times) {
    clearTimeout(holding);
    const due = performance.now() + SENT;
    holding = setTimeout(() => {
      const now = performance.now();
      // where this timer is late the page is busy, and viser's are late as well
      const left = now - due > SENT / 2 && now - since < BUSY ? 2 : times - 1;
      if (left) wait(left); else go();
    }, SENT);
  }

  function go() {
    holding = 0;
    for (const input of again) {
      again.delete(input);
      if (input.isConnected) return write(input, `${input.value} `), write(input, input.value.slice(0, -1));
    }
    while (!holding && later.length) later.shift()();
  }

  function soon(act) {
    later.push(act);
    if (!holding) go();
  }

  function write(input, value) { // as if it were typed
    const kind = input instanceof HTMLTextAreaElement ? HTMLTextAreaElement : HTMLInputElement;
    Object.getOwnPropertyDescriptor(kind.prototype, "value").set.call(input, value);
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }

  addEventListener("input", ({ target }) => {
    if (holding && last && last !== target) again.add(last); // typing cannot wait: what it overtook is sent once more
    last = target.matches("textarea, input[type=text]:not([aria-haspopup])") ? target : null;
    hold();
  }, true);

  addEventListener("click", (event) => {
    const found = event.target instanceof Element
      && event.target.closest("button, [role=button], [role=option], input[type=checkbox], input[type=radio]");
    if (!found) return;
    if (!event.isTrusted || !holding) return last = null, hold();
    event.preventDefault();
    event.stopImmediatePropagation();
    later.push(() => anew(found).click());
  }, true);

  function anew(button) { // the panel may have been drawn again meanwhile
    if (button.isConnected) return button;
    const alike = [...document.querySelectorAll(button.tagName)];
    return alike.find((each) => each.textContent === button.textContent) || button;
  }

  for (const kind of ["keydown", "pointermove", "pointerup"]) { // sliders
    addEventListener(kind, (event) => {
      if (!(event.target instanceof Element) || !event.target.closest("[role=slider], [class*=Slider]")) return;
      if (kind === "pointermove" && !event.buttons) return;
      if (holding && last) again.add(last);
      last = null;
      hold();
    }, true);
  }

  function tab(name, tries) {
    const found = [...document.querySelectorAll("[role=tab]")].find((each) => each.textContent.trim() === name);
    if (!found) {
      if (tries) setTimeout(() => tab(name, tries - 1), 100);
    } else if (found.getAttribute("aria-selected") !== "true") { // it can be dragged: a click alone does not open it
      const { left, top, width, height } = found.getBoundingClientRect();
      const at = { bubbles: true, cancelable: true, pointerId: 1, pointerType: "mouse", isPrimary: true, button: 0,
        clientX: left + width / 2, clientY: top + height / 2 };
      found.dispatchEvent(new PointerEvent("pointerdown", { ...at, buttons: 1 }));
      found.dispatchEvent(new PointerEvent("pointerup", at));
      found.dispatchEvent(new MouseEvent("click", at));
    }
  }

  function labelled(name) {
    for (const input of document.querySelectorAll("input")) if (input.dataset.tmd === name) return input;
    return null;
  }

  function send(event) {
    recent = [...recent, { ...event, number: ++number }].slice(-8); // what was sent just before may not be read yet
    if (unsent) return;
    unsent = () => {
      unsent = null;
      const input = labelled(EVENT);
      if (input) write(input, JSON.stringify(recent));
    };
    soon(unsent);
  }

  dark.addEventListener("change", () => send({ dark: dark.matches }));

  // whether the studio is there
  let instance = "", banner = null, before = null;

  function say(words) {
    if (!words) return banner && banner.remove(), (banner = null);
    if (!banner) {
      banner = document.createElement("div");
      banner.id = "tmd-ended";
      banner.setAttribute("role", "alert");
      document.body.append(banner);
    }
    banner.textContent = words;
  }

  async function look() {
    try {
      const answer = await fetch("/alive", { cache: "no-store", signal: AbortSignal.timeout(4000) });
      if (answer.status === 403) return say("The studio has another token now: open the address that tmd studio printed.");
      const now = await answer.text();
      if (instance && instance !== now) { // viser connects again by itself; where nothing new comes of that, load anew
        setTimeout(() => { if (before && before.isConnected) location.reload(); }, PATIENCE);
      }
      say("");
      instance = now;
    } catch {
      before = document.querySelector("[role=status]");
      say("The studio has ended, or cannot be reached. What you did is kept. Start it again with tmd studio: "
        + "this page comes back by itself.");
    }
  }
  setInterval(look, LOOK);

  // keys in text boxes: Enter plans or begins, Ctrl-K and Alt with a letter are commands, Escape leaves
  function written(target) {
    return target instanceof HTMLTextAreaElement || (target instanceof HTMLInputElement && target.type === "text");
  }

  function elsewhere(event, key, held) {
    event.preventDefault();
    event.stopImmediatePropagation();
    document.activeElement.blur();
    const code = event.code;
    soon(() => document.documentElement.dispatchEvent(
      new KeyboardEvent("keydown", { key, code, ctrlKey: held, bubbles: true, cancelable: true })));
  }

  addEventListener("keydown", (event) => {
    if (!event.isTrusted || !written(event.target)) return;
    if (event.key === "Enter" && event.target instanceof HTMLTextAreaElement && !event.shiftKey && !event.isComposing) {
      event.preventDefault();
      const panel = event.target.closest("[role=tabpanel]") || document;
      const button = [...panel.querySelectorAll("button")].find((each) =>
        ["Plan it", "Begin", "Start over"].includes(each.textContent.trim()) && each.offsetParent);
      if (button) soon(() => button.click());
    } else if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "k") elsewhere(event, "k", true);
    else if (event.altKey && /^Key[A-Z]$/.test(event.code)) elsewhere(event, event.code.slice(3).toLowerCase(), false);
    else if (event.key === "Escape") event.target.blur();
  }, true);

  // steps can be clicked, and chosen with Enter
  function step(event) {
    const found = event.target instanceof Element && event.target.closest("[data-step]");
    if (!found || (event.type === "keydown" && event.key !== "Enter")) return;
    send({ step: Number(found.dataset.step), list: found.closest("[data-list]")?.dataset.list || "" });
  }
  addEventListener("click", (event) => {
    const node = event.target instanceof Element && event.target.closest("#tmd-graph [data-object]");
    if (node) send({ object: node.dataset.object });
  });
  addEventListener("click", step);
  addEventListener("keydown", step);

  // a click on nothing in the picture: the server knows whether it was on an object
  let down = null;
  addEventListener("pointerdown", (event) => { down = event.target instanceof HTMLCanvasElement ? event : null; }, true);
  addEventListener("pointerup", (event) => {
    if (!down || !(event.target instanceof HTMLCanvasElement)) return;
    if (Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 4) {
      setTimeout(() => send({ clicked: true }), 700);
    }
  }, true);

  // after each change of the page: names for what has none, the caption over the picture, the list follows
  const NAMES = { "tabler-icon-x": "Close", "tabler-icon-search": "Search commands", "tabler-icon-moon": "Dark mode",
    "tabler-icon-sun": "Light mode", "tabler-icon-chevron-down": "Fold", "tabler-icon-chevron-up": "Unfold",
    "tabler-icon-qrcode": "QR code", "tabler-icon-adjustments": "Settings", "tabler-icon-settings": "Settings",
    "tabler-icon-camera": "Camera", "tabler-icon-home": "The first view", "tabler-icon-minus": "Make smaller",
    "tabler-icon-plus": "Make larger" };
  let followed = "", waiting = false;

  function label(input) {
    for (let box = input.parentElement, up = 0; box && up < 7; box = box.parentElement, up += 1) {
      const text = [...box.querySelectorAll("label, [class*=label], div, p")].find((each) =>
        each.children.length === 0 && /\p{L}/u.test(each.textContent) && !each.contains(input) && !each.closest("[role=option]"));
      if (text) return [text.textContent.trim(), box];
    }
    return ["", null];
  }

  function unwarn() { // where graphics are drawn by software, that is said for a while, and then the picture is free again
    for (const each of document.querySelectorAll(".mantine-Notification-root")) {
      if (each.textContent.includes("Software WebGL") && !each.dataset.tmd) {
        each.dataset.tmd = "seen";
        setTimeout(() => each.querySelector("button")?.click(), 6000);
      }
    }
  }

  function tidy() {
    waiting = false;
    unwarn();
    for (const input of document.querySelectorAll("input:not([data-tmd]), textarea:not([data-tmd])")) {
      if (!input.isConnected || input.type === "hidden") continue;
      const [name, row] = label(input);
      if (!name) continue;
      input.dataset.tmd = name;
      if (!input.getAttribute("aria-label")) input.setAttribute("aria-label", name);
      if (name === EVENT && row) row.classList.add("tmd-unseen");
      if (name === EVENT) input.tabIndex = -1;
      if (input instanceof HTMLTextAreaElement) input.placeholder ||= "What is to be done, in English. Enter goes on.";
    }
    for (const slider of document.querySelectorAll("[role=slider]")) {
      if (!slider.getAttribute("aria-label")) slider.setAttribute("aria-label", label(slider)[0]);
    }
    for (const button of document.querySelectorAll("button:not([aria-label]), [role=button]:not([aria-label])")) {
      if (button.textContent.trim()) continue;
      if (button.className.includes("CloseButton")) button.setAttribute("aria-label", "Close");
      const icon = button.querySelector("svg[class*=tabler-icon-]");
      const kind = icon && [...icon.classList].find((each) => each.startsWith("tabler-icon-"));
      if (kind) button.setAttribute("aria-label", NAMES[kind] || kind.slice(12).replaceAll("-", " "));
    }
    theme();
    caption();
    graph();
    follow();
  }

  function theme() { // the pieces that tmd draws are as dark as viser's
    const scheme = document.documentElement.dataset.mantineColorScheme === "dark" ? "dark" : "light";
    if (document.documentElement.dataset.theme !== scheme) document.documentElement.dataset.theme = scheme;
  }

  function caption() {
    const said = document.querySelector(".tmd-caption")?.textContent.trim() || "";
    let over = document.getElementById("tmd-over");
    if (!over) {
      over = document.createElement("div");
      over.id = "tmd-over";
      over.setAttribute("aria-hidden", "true"); // the panel says it already
      document.body.append(over);
    }
    if (over.textContent !== said) over.textContent = said;
    const canvas = document.querySelector("canvas");
    if (canvas) {
      const place = canvas.getBoundingClientRect();
      over.style.left = `${place.left + place.width / 2}px`;
      over.style.maxWidth = `${Math.max(place.width - 24, 120)}px`;
    }
  }

  let shown = null;

  function graph() { // what has no picture is drawn as a graph, over the empty one
    const found = document.querySelector(".tmd-state");
    let over = document.getElementById("tmd-graph");
    if (!over) {
      over = document.createElement("div");
      over.id = "tmd-graph";
      over.className = "tmd";
      document.body.append(over);
    }
    if ((found && found.innerHTML) !== shown) {
      shown = found && found.innerHTML;
      over.innerHTML = shown || "";
    }
    over.hidden = !shown;
    const place = document.querySelector("canvas")?.getBoundingClientRect();
    if (place) over.style.width = `${place.width}px`;
  }

  function follow() {
    const now = [...document.querySelectorAll("[aria-current=step]")].find((each) => each.offsetParent);
    const words = now ? now.textContent + now.closest("li")?.dataset.step : "";
    if (now && words !== followed) (now.closest("li") || now).scrollIntoView({ block: "nearest" });
    followed = words;
  }

  addEventListener("DOMContentLoaded", () => {
    new MutationObserver(() => {
      if (!waiting) waiting = true, setTimeout(tidy, SOON); // not with a frame: where graphics are slow, those are rare
    }).observe(document.documentElement, {
      subtree: true, childList: true, characterData: true, attributeFilter: ["data-mantine-color-scheme"] });
    addEventListener("click", (event) => {
      const found = event.target instanceof Element && event.target.closest("[role=tab]");
      if (found) send({ tab: found.textContent.trim() });
    });
  });
})();
