// Colours of canvases, taken from the page's style so that light, dark and print agree.

import { interpolateViridis } from "d3-scale-chromatic";
import { drawAllNow } from "./dom.js";

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Ends of the colour map that stand out from the background: [darkest, lightest]. */
function shades() {
  return colour("scheme") === "dark" ? [0.2, 1] : [0, 0.86];
}

/** Colour of a score from 0 to 100; perceptually even, and so for all kinds of colour vision. */
export function scoreColour(score) {
  const [low, high] = shades();
  return interpolateViridis(low + ((high - low) * score) / 100);
}

/** Whether the page is drawn for paper: each figure then on one canvas, since a second would hide it. */
export const isPrinting = () => "print" in document.documentElement.dataset;

/** Calls back when light turns dark or the page is printed. */
export function onThemeChange(redraw) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  const root = document.documentElement;
  addEventListener("beforeprint", () => {
    root.dataset.print = "yes";
    drawAllNow();
    redraw();
  });
  addEventListener("afterprint", () => {
    delete root.dataset.print;
    redraw();
  });
}

/**
 * Makes a canvas fit its box at the screen's resolution, which also empties it; returns its context in
 * CSS pixels.
 */
export function fit(canvas, width, height) {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.width = `${width}px`;
  canvas.style.height = `${height}px`;
  // Drawn by the processor: where graphics are emulated, thousands of points take seconds else.
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}
