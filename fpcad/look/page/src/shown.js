/** When the browser has shown what was drawn. */
export const shown = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
