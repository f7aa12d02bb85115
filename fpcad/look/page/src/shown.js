/** When the browser has shown what was drawn. */
export const shown = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));

/** When the browser has shown what was drawn, and all that the reader picked meanwhile. */
export async function settled(state) {
  let selected;
  do {
    selected = state.selected;
    await shown();
  } while (state.selected !== selected);
}
