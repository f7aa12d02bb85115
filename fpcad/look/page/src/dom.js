// Small helpers for elements. Text is always set as text, never as markup.

export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== null && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

export function format(value, digits = 1) {
  if (value === null || Number.isNaN(value)) return "–";
  return value.toFixed(digits).replace("-", "−");
}

/** Calls back with the width of an element, when it is first drawn and whenever it changes. */
export function onResize(element, redraw) {
  let last = 0;
  const measure = () => {
    const width = Math.floor(element.clientWidth);
    if (width > 0 && width !== last) redraw((last = width));
  };
  whenSeen(element, () => {
    measure();
    new ResizeObserver(measure).observe(element);
  });
}

const unseen = new Map(); // elements and what is to be done when they come into sight
const sight = new IntersectionObserver((entries) => entries.forEach((entry) => entry.isIntersecting && see(entry.target)), { rootMargin: "400px" });

/** Does something when an element comes into sight; when nothing else is to be done, before. */
function whenSeen(element, act) {
  unseen.set(element, act);
  sight.observe(element);
}

function see(element) {
  const act = unseen.get(element);
  unseen.delete(element);
  sight.unobserve(element);
  act?.();
}

/** Draws what is out of sight, one element after the other. */
export async function drawUnseen() {
  for (;;) {
    await idle();
    const [element] = unseen.keys();
    if (!element) return;
    see(element);
  }
}

/** Draws everything now, for the printer. */
export function drawAllNow() {
  [...unseen.keys()].forEach(see);
}

const idle = () => new Promise((done) => (window.requestIdleCallback ? requestIdleCallback(done, { timeout: 300 }) : setTimeout(done, 30)));
