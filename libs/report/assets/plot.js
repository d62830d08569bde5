// A figure of the page: its Vega specification shown, with axes that can be moved and layers that can be hidden.

/** The rows of a data set that the page holds by columns. */
function rowsOf({columns, values}) {
  const names = columns.map(String);
  const count = names.length ? values[0].length : 0;
  return Array.from({length: count}, (_, i) => Object.fromEntries(names.map((name, c) => [name, values[c][i]])));
}

class Plot {
  constructor(element) {
    this.element = element;
    this.canvas = element.querySelector('.canvas');
    this.source = JSON.parse(element.querySelector('script.spec').textContent);
    for (const set of this.source.data) {
      if (set.columns) Object.assign(set, {values: rowsOf(set), columns: undefined});
    }
    this.panels = this.source.usermeta.panels;
    this.layers = this.source.usermeta.layers;
    this.hidden = new Set();
    this.domains = this.panels.map((panel) => ({x: panel.x.domain, y: panel.y.domain}));
  }

  /** The specification with a signal for every axis that can be moved and every layer with a name. */
  specification(colours = theme.themed) {
    const spec = {...colours(this.source), signals: [], usermeta: undefined};
    spec.config = {...spec.config, aria: false};
    spec.marks = spec.marks.map((mark) => {
      const panel = /^panel_(\d+)$/.exec(mark.name || '');
      return panel ? this.withSignals(mark, Number(panel[1]), spec.signals) : mark;
    });
    return spec;
  }

  withSignals(group, index, signals) {
    const scales = group.scales.map((scale) => {
      if (!this.panels[index][scale.name].moves) return scale;
      signals.push({name: `${scale.name}_${index}`, value: this.domains[index][scale.name]});
      return {...scale, domain: {signal: `${scale.name}_${index}`}};
    });
    const marks = group.marks.map((mark) => {
      if (!mark.name) return mark;
      signals.push({name: mark.name, value: this.isShown(mark.name)});
      const {update} = mark.encode, opacity = update.opacity ? update.opacity.value : 1;
      return {...mark, encode: {update: {...update, opacity: {signal: `${mark.name} ? ${opacity} : 0`}}}};
    });
    return {...group, scales, marks};
  }

  isShown(mark) {
    const layer = this.layers.find((entry) => entry.marks.includes(mark));
    return !layer || !this.hidden.has(layer.label);
  }

  show() {
    if (this.view) this.view.finalize();
    const spec = this.specification();
    const marks = this.source.usermeta.symbols;
    const many = 4000;  // more elements than this make an SVG slow
    this.view = new vega.View(vega.parse(spec), {renderer: marks > many ? 'canvas' : 'svg', hover: false});
    // Vega gives its element a role of its own. Words for what is seen are the figure's; where that takes keys it is a
    // group, and the picture within it has the words.
    const place = document.createElement('div');
    this.canvas.replaceChildren(place);
    this.view.initialize(place).run();
    for (const name of ['role', 'aria-roledescription', 'aria-label']) place.removeAttribute(name);
    if (this.canvas.getAttribute('role') === 'group') {
      place.setAttribute('role', 'img');
      place.setAttribute('aria-label', this.canvas.getAttribute('aria-label'));
    }
    this.element.dataset.shown = 'true';
  }

  /** Images load too slowly to be drawn when printing has begun, so figures with one keep a picture for it. */
  async keepForPaper() {
    const hasImage = this.source.marks.some(({marks = []}) => marks.some(({type}) => type === 'image'));
    if (!hasImage) return;
    const view = new vega.View(vega.parse(this.specification((spec) => spec)), {renderer: 'none'});
    this.paper = await view.toSVG();
    view.finalize();
  }

  toggle(label, shown) {
    if (shown) this.hidden.delete(label);
    else this.hidden.add(label);
    if (!this.view) return;
    for (const mark of this.layers.find((entry) => entry.label === label).marks) this.view.signal(mark, shown);
    this.view.run();
  }

  /** The panel below a point of the screen, and where in it the point lies, from 0 to 1. */
  panelAt(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    const scale = this.source.width / box.width;
    const x = (clientX - box.left) * scale, y = (clientY - box.top) * scale;
    for (const [index, panel] of this.panels.entries()) {
      const right = (x - panel.left) / panel.width, up = 1 - (y - panel.top) / panel.height;
      if (right >= 0 && right <= 1 && up >= 0 && up <= 1) return {index, right, up, scale};
    }
    return null;
  }

  /** Whether two panels are courses over one span. */
  goTogether(panel, other) {
    return !panel.equal && !other.equal && String(panel.x.domain) === String(other.x.domain);
  }

  /** The first of all panels that move together, for each that can be moved. */
  leaders() {
    const moving = this.panels.map((panel, index) => ({panel, index})).filter(({panel}) => panel.x.moves);
    return moving.filter(({panel}, i) => !moving.slice(0, i).some((before) => this.goTogether(panel, before.panel)))
        .map(({index}) => index);
  }

  /** Gives a panel other ends of its axes. Panels of one time span move together. */
  move(index, change) {
    const moved = this.panels[index];
    this.panels.forEach((panel, i) => {
      for (const axis of ['x', 'y']) {
        const together = axis === 'x' && this.goTogether(panel, moved);
        if (!panel[axis].moves || (i !== index && !together)) continue;
        this.domains[i][axis] = change(this.domains[i][axis], axis, panel);
        if (this.view) this.view.signal(`${axis}_${i}`, this.domains[i][axis]);
      }
    });
    if (this.view) this.view.run();
  }

  /** Zooms about a point of the panel; time courses along their x axis only. */
  zoom(factor, {index, right, up}) {
    this.move(index, ([low, high], axis, panel) => {
      if (axis === 'y' && !panel.equal) return [low, high];
      const fixed = low + (high - low) * (axis === 'x' ? right : up);
      return [fixed + (low - fixed) * factor, fixed + (high - fixed) * factor];
    });
  }

  /** Moves by parts of the panel's width and height. */
  pan(index, right, up) {
    this.move(index, ([low, high], axis, panel) => {
      if (axis === 'y' && !panel.equal) return [low, high];
      const shift = (high - low) * (axis === 'x' ? right : up);
      return [low + shift, high + shift];
    });
  }

  reset() {
    this.panels.forEach((_, i) => this.move(i, (domain, axis, panel) => panel[axis].domain));
  }

  valueAt(index, axis, part) {
    const [low, high] = this.domains[index][axis];
    return this.panels[index][axis].log ? low * Math.pow(high / low, part) : low + (high - low) * part;
  }
}
