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
      const zoomAll = (factor) => this.zoomAll(factor);
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
    canvas.addEventListener('pointercancel', () => { this.held = null; });
    canvas.addEventListener('keydown', (event) => this.key(event));
    canvas.addEventListener('blur', () => { if (this.mark) this.mark.remove(); });
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

  /** About the middle, every panel whose x axis can be moved. */
  zoomAll(factor) {
    for (const index of this.plot.leaders()) this.plot.zoom(factor, {index, right: 0.5, up: 0.5});
  }

  panAll(right, up) {
    for (const index of this.plot.leaders()) this.plot.pan(index, right, up);
  }

  /** Arrows read values of courses; with Shift, and on maps always, they move the axes. */
  key(event) {
    const {plot} = this, map = plot.panels[0].equal, arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1],
                                                                ArrowDown: [0, -1]};
    const others = {'+': () => this.zoomAll(0.8), '-': () => this.zoomAll(1.25), '0': () => plot.reset()};
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = arrows[event.key];
    if (!arrow && !others[event.key]) return;
    event.preventDefault();
    if (!arrow) others[event.key]();
    else if (map || event.shiftKey) this.panAll(0.1 * arrow[0], map ? 0.1 * arrow[1] : 0);
    else this.readOn(...arrow);
  }

  /** The next place of the cursor along x, or the panel above or below; said in words, and moved along where the cursor
      leaves what is shown. */
  readOn(right, up) {
    const {plot} = this, last = plot.panels.length - 1;
    const at = this.cursor || {index: 0, right: 0.5, up: 0.5};
    if (this.cursor) {
      at.index = Math.min(Math.max(at.index - up, 0), last);
      at.right += right * 0.02;
      const beyond = at.right < 0 ? at.right : Math.max(at.right - 1, 0);
      if (beyond !== 0 && plot.panels[at.index].x.moves) plot.pan(at.index, beyond, 0);
      at.right = Math.min(Math.max(at.right, 0), 1);
    }
    this.cursor = at;
    const panel = plot.panels[at.index];
    this.readout.textContent = (last > 0 ? `${panel.y.title}: ` : '') + this.valuesAt(at);
    this.showCursor(panel, at.right);
  }

  showCursor(panel, right) {
    const {canvas, source} = this.plot;
    if (!this.mark) {
      this.mark = document.createElement('div');
      this.mark.className = 'cursor';
    }
    const part = (length, whole) => `${100 * length / whole}%`;
    Object.assign(this.mark.style, {left: part(panel.left + right * panel.width, source.width),
                                    top: part(panel.top, source.height), height: part(panel.height, source.height)});
    canvas.append(this.mark);
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
