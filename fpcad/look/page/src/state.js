// What is selected and what passes the filters; everybody who draws listens.

export class State {
  #listeners = { select: [], filter: [] };

  constructor(run) {
    this.run = run;
    this.count = run.candidates.count;
    this.selected = run.chosen ?? (this.count ? 0 : null);
    this.passing = new Uint8Array(this.count).fill(1);
    this.limits = new Map(); // column name -> [low, high]
  }

  on(event, listener) {
    this.#listeners[event].push(listener);
  }

  select(row) {
    if (row === null || row === this.selected) return;
    this.selected = row;
    this.#listeners.select.forEach((listener) => listener(row));
  }

  /** Restricts a column to [low, high]; null lifts the restriction. */
  limit(column, range) {
    if (range) this.limits.set(column.name, { values: column.data, range });
    else this.limits.delete(column.name);
    const limits = [...this.limits.values()];
    for (let row = 0; row < this.count; row++) {
      const inside = ({ values, range: [low, high] }) => values[row] >= low && values[row] <= high;
      this.passing[row] = limits.every(inside) ? 1 : 0;
    }
    this.#listeners.filter.forEach((listener) => listener());
  }
}
