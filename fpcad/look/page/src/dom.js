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

/** Calls back with the width of an element, now and whenever it changes. */
export function onResize(element, redraw) {
  let last = 0;
  new ResizeObserver(() => {
    const width = Math.floor(element.clientWidth);
    if (width > 0 && width !== last) redraw((last = width));
  }).observe(element);
}
