"use strict";
(() => {
  const steps = [...document.querySelectorAll(".step")];
  if (!steps.length) return;
  let at = -1;
  const bar = document.createElement("div");
  bar.id = "walk";
  const label = document.createElement("span");
  label.setAttribute("aria-live", "polite");
  const go = (to) => {
    at = Math.max(0, Math.min(steps.length - 1, to));
    const step = steps[at];
    if (step.tagName === "DETAILS") step.open = true;
    step.scrollIntoView({ block: "start" });
    step.focus({ preventScroll: true });
    tell();
  };
  const tell = () => { label.textContent = (at < 0 ? "steps" : "step " + (at + 1)) + " of " + steps.length; };
  const button = (text, name, by) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.setAttribute("aria-label", name);
    made.addEventListener("click", () => go(at + by));
    return made;
  };
  tell();
  label.textContent = steps.length + " steps: arrow keys";
  bar.append(button("‹", "step before", -1), label, button("›", "next step", 1));
  document.body.append(bar);
  document.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by || event.target.closest(".tmd-scroll")) return;
    event.preventDefault();
    go(at + by);
  });
})();
