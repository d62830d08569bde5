// What a reader does with a figure: zoom, move, read values, hide layers, save a picture.

function button(text, label, action) {
  const element = document.createElement('button');
  element.type = 'button';
  element.textContent = text;
  element.setAttribute('aria-label', label);
  element.title = label;
  element.addEventListener('click', action);
  return element;
}

function save(url, name) {
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
}

const shortNumber = (value) => Number(value.toPrecision(4)).toString();

/** The row of a time course whose x is nearest. */
function nearestRow(rows, x) {
  let best = null;
  for (const row of rows) {
    if (row.x === null || row.y === null || row.y === undefined) continue;
    if (!best || Math.abs(row.x - x) < Math.abs(best.x - x)) best = row;
  }
  return best;
}

class PlotTools {
  constructor(plot, name) {
    this.plot = plot;
    this.readout = plot.element.querySelector('.readout');
    const bar = plot.element.querySelector('.tools');
    if (plot.panels.some((panel) => panel.x.moves)) {
      const middle = {right: 0.5, up: 0.5};
      const zoomAll = (factor) => plot.panels.some((panel, index) => {
        plot.zoom(factor, {index, ...middle});
        return !panel.equal;  // panels of one time span moved together
      });
      bar.append(button('+', 'Zoom in', () => zoomAll(0.8)), button('−', 'Zoom out', () => zoomAll(1.25)),
                 button('Reset', 'Show all again', () => plot.reset()));
      this.listen();
    }
    bar.append(button('SVG', 'Save as SVG', () => this.savePicture('svg', name)),
               button('PNG', 'Save as PNG', () => this.savePicture('png', name)));
    this.addLayers();
  }

  savePicture(kind, name) {
    this.plot.view.toImageURL(kind, kind === 'png' ? 2 : 1).then((url) => save(url, `${name}.${kind}`));
  }

  addLayers() {
    const {layers} = this.plot;
    const place = this.plot.element.querySelector('.layers');
    if (layers.length < 2) {
      place.remove();
      return;
    }
    const list = place.querySelector('.choices');
    for (const {label} of layers) {
      const choice = document.createElement('label');
      const box = document.createElement('input');
      box.type = 'checkbox';
      box.checked = true;
      box.addEventListener('change', () => this.plot.toggle(label, box.checked));
      choice.append(box, ` ${label}`);
      list.append(choice);
    }
  }

  listen() {
    const {canvas} = this.plot;
    canvas.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    canvas.addEventListener('pointerdown', (event) => this.grab(event));
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    canvas.addEventListener('pointerup', () => { this.held = null; });
    canvas.addEventListener('pointerleave', () => { this.readout.textContent = ''; });
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** Only where the reader has chosen the figure: the wheel is for the page otherwise. */
  wheel(event) {
    const at = this.plot.panelAt(event.clientX, event.clientY);
    if (!at || !(event.ctrlKey || document.activeElement === this.plot.canvas)) return;
    event.preventDefault();
    this.plot.zoom(Math.exp(0.002 * event.deltaY), at);
  }

  grab(event) {
    this.held = this.plot.panelAt(event.clientX, event.clientY);
    if (this.held) this.plot.canvas.setPointerCapture(event.pointerId);
  }

  drag(event) {
    const at = this.plot.panelAt(event.clientX, event.clientY);
    if (this.held && at && at.index === this.held.index) {
      this.plot.pan(at.index, this.held.right - at.right, this.held.up - at.up);
      this.held = at;
    } else if (at) {
      this.readout.textContent = this.valuesAt(at);
    }
  }

  key(event) {
    const step = 0.1, {plot} = this;
    const actions = {
      '+': () => plot.zoom(0.8, {index: 0, right: 0.5, up: 0.5}),
      '-': () => plot.zoom(1.25, {index: 0, right: 0.5, up: 0.5}),
      '0': () => plot.reset(),
      ArrowLeft: () => plot.pan(0, -step, 0),
      ArrowRight: () => plot.pan(0, step, 0),
      ArrowUp: () => plot.pan(0, 0, step),
      ArrowDown: () => plot.pan(0, 0, -step),
    };
    const vertical = event.key === 'ArrowUp' || event.key === 'ArrowDown';
    if (!actions[event.key] || event.ctrlKey || (vertical && !plot.panels[0].equal)) return;
    event.preventDefault();
    actions[event.key]();
  }

  valuesAt({index, right, up}) {
    const panel = this.plot.panels[index];
    const x = this.plot.valueAt(index, 'x', right), y = this.plot.valueAt(index, 'y', up);
    const named = (axis, value) => `${axis.title} ${shortNumber(value)}`;
    if (panel.equal || panel.x.categories) return `${named(panel.x, x)}, ${named(panel.y, y)}`;
    const parts = [named(panel.x, x)];
    for (const layer of this.plot.layers) {
      const mark = layer.marks.find((name) => name.startsWith(`mark_p${index}_`));
      const set = mark && this.plot.source.data.find(({name}) => `mark_${name}` === mark);
      const row = set && nearestRow(set.values, x);
      if (row) parts.push(`${layer.label} ${shortNumber(row.y)}`);
    }
    return parts.slice(0, 6).join(' · ');
  }
}
