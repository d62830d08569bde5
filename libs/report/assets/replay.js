// The run again, step by step: robot, tracks, landmarks as they appear, field of view and what is in sight.

class Replay {
  constructor(element) {
    this.element = element;
    this.data = JSON.parse(element.querySelector('script.data').textContent);
    for (const {id, data} of this.data.layers) {
      if (id === 'robot' || id === 'tracks' || id === 'landmarks') this.data[id] = data;  // other layers ask for them
    }
    this.canvas = element.querySelector('canvas');
    this.stage = element.querySelector('.stage');
    this.slider = element.querySelector('input[type=range]');
    this.playButton = element.querySelector('.play');
    this.speed = element.querySelector('.speed');
    this.state = element.querySelector('.state');
    this.frame = 0;
    this.zoom = 1;
    this.middle = [0, 1].map((axis) => (this.data.low[axis] + this.data.high[axis]) / 2);
    this.placesOfLandmarks();
    this.listen();
    this.show(this.data.times.length - 1);
  }

  /** For every landmark the places in its history, in the order of time. */
  placesOfLandmarks() {
    const {count, index} = this.data.landmarks;
    this.history = Array.from({length: count}, () => []);
    index.forEach((landmark, row) => this.history[landmark].push(row));
  }

  listen() {
    this.slider.max = this.data.times.length - 1;
    this.slider.addEventListener('input', () => { this.pause(); this.show(Number(this.slider.value)); });
    this.playButton.addEventListener('click', () => (this.playing ? this.pause() : this.play()));
    this.element.querySelectorAll('input[type=checkbox]').forEach(
        (box) => box.addEventListener('change', () => this.draw()));
    this.element.querySelector('.whole').addEventListener('click', () => this.whole());
    this.stage.addEventListener('keydown', (event) => this.key(event));
    this.canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== this.stage) return;
      event.preventDefault();
      this.enlarge(Math.exp(-0.002 * event.deltaY));
    }, {passive: false});
    this.canvas.addEventListener('pointerdown', (event) => {
      this.held = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const end of ['pointerup', 'pointercancel']) this.canvas.addEventListener(end, () => { this.held = null; });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  key(event) {
    const last = this.data.times.length - 1, far = Math.max(1, Math.round(last / 50));
    const to = {ArrowLeft: this.frame - 1, ArrowRight: this.frame + 1, PageUp: this.frame - far,
                PageDown: this.frame + far, Home: 0, End: last}[event.key];
    if (to !== undefined) { this.pause(); this.show(to); }
    else if (event.key === ' ') this.playing ? this.pause() : this.play();
    else if (event.key === '+') this.enlarge(1.25);
    else if (event.key === '-') this.enlarge(0.8);
    else if (event.key === '0') this.whole();
    else return;
    event.preventDefault();
  }

  enlarge(factor) {
    this.zoom = Math.max(1, this.zoom * factor);
    this.draw();
  }

  whole() {
    this.zoom = 1;
    this.middle = [0, 1].map((axis) => (this.data.low[axis] + this.data.high[axis]) / 2);
    this.draw();
  }

  drag(event) {
    if (!this.held) return;
    const scale = this.scale();
    this.middle[0] -= (event.clientX - this.held[0]) / scale;
    this.middle[1] += (event.clientY - this.held[1]) / scale;
    this.held = [event.clientX, event.clientY];
    this.draw();
  }

  play() {
    const {times} = this.data, last = times.length - 1;
    if (this.frame === last) this.show(0);
    this.playing = true;
    this.playButton.textContent = 'Pause';
    let before = performance.now(), time = times[this.frame];
    const tick = (now) => {
      if (!this.playing) return;
      time += (now - before) / 1000 * Number(this.speed.value);
      before = now;
      let frame = this.frame;
      while (frame < last && times[frame + 1] <= time) ++frame;
      if (frame !== this.frame) this.show(frame);
      if (frame === last) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = false;
    this.playButton.textContent = 'Play';
  }

  show(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.data.times.length - 1);
    this.slider.value = this.frame;
    const text = this.inWords();
    this.slider.setAttribute('aria-valuetext', text);
    this.state.textContent = text;
    this.draw();
  }

  inWords() {
    const {times, robot, tracks, modes, landmarkCount} = this.data, i = this.frame;
    const degrees = (robot.theta[i] * 180 / Math.PI).toFixed(1);
    const parts = [`${times[i].toFixed(2)} s of ${times[times.length - 1].toFixed(2)} s`,
                   `robot at ${robot.x[i].toFixed(2)}, ${robot.y[i].toFixed(2)} m, heading ${degrees}°`,
                   `${landmarkCount[i] ?? this.knownLandmarks().length} landmarks`];
    for (const track of tracks) {
      const k = i - track.from;
      if (track.x[k] === undefined || track.x[k] === null || parts.length > 6) continue;
      parts.push(track.name + (modes.length > 1 ? `: ${modes[track.mode[k]].name}` : ''));
    }
    return parts.join(' · ');
  }

  /** The row of history that says where each landmark was, as far as it is known by now. */
  knownLandmarks() {
    if (this.knownAt === this.frame) return this.known;
    const {frame} = this.data.landmarks, rows = [];
    for (const places of this.history) {
      let low = 0, high = places.length;
      while (low < high) {
        const half = (low + high) >> 1;
        if (frame[places[half]] <= this.frame) low = half + 1;
        else high = half;
      }
      if (low > 0 && this.data.landmarks.x[places[low - 1]] !== null) rows.push(places[low - 1]);
    }
    this.knownAt = this.frame;
    this.known = rows;
    return rows;
  }

  /** Whether a layer's box is checked; one without a box is always shown. */
  wants(layer) {
    const box = this.element.querySelector(`input[type=checkbox][value=${layer}]`);
    return !box || box.checked;
  }

  scale() {
    const {low, high} = this.data, box = this.canvas.getBoundingClientRect();
    return this.zoom * Math.min(box.width / (high[0] - low[0]), box.height / (high[1] - low[1]));
  }

  draw() {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    if (box.width === 0) return;
    this.box = box;
    this.themeKey();
    this.canvas.width = Math.round(box.width * ratio);
    this.canvas.height = Math.round(box.height * ratio);
    if (this.wants('follow')) this.middle = [this.data.robot.x[this.frame], this.data.robot.y[this.frame]];
    const scale = this.scale();
    this.context = this.canvas.getContext('2d');
    this.context.scale(ratio, ratio);
    this.toX = (x) => (x - this.middle[0]) * scale + box.width / 2;
    this.toY = (y) => (this.middle[1] - y) * scale + box.height / 2;
    this.pixels = scale;
    for (const {id, data} of this.data.layers) {
      if (this.wants(id)) replayLayers[id](this, data);
    }
    this.drawScaleBar(box);
  }

  /** The colours of the list of what is drawn. */
  themeKey() {
    for (const part of this.element.querySelectorAll('.key [data-colour]')) {
      for (const name of ['fill', 'stroke']) {
        if (part.hasAttribute(name) && part.getAttribute(name) !== 'none') part.setAttribute(name, theme.colourOf(part.dataset.colour));
      }
    }
  }

  line(xs, ys, from, to, colour, width, opacity = 1) {
    const c = this.context;
    c.strokeStyle = theme.colourOf(colour);
    c.lineWidth = width;
    c.globalAlpha = opacity;
    c.beginPath();
    let down = false;
    for (let i = Math.max(from, 0); i < Math.min(to, xs.length); ++i) {
      if (xs[i] === null) { down = false; continue; }
      if (down) c.lineTo(this.toX(xs[i]), this.toY(ys[i]));
      else c.moveTo(this.toX(xs[i]), this.toY(ys[i]));
      down = true;
    }
    c.stroke();
    c.globalAlpha = 1;
  }

  ellipse(x, y, a, b, angle) {
    const c = this.context, cx = this.toX(x), cy = this.toY(y);
    c.moveTo(cx + a * this.pixels * Math.cos(angle), cy - a * this.pixels * Math.sin(angle));
    c.ellipse(cx, cy, a * this.pixels, b * this.pixels, -angle, 0, 2 * Math.PI);
  }

  /** A round number of metres, about a sixth of the picture. */
  drawScaleBar(box) {
    const wanted = box.width / 6 / this.pixels, power = Math.pow(10, Math.floor(Math.log10(wanted)));
    const length = power * (wanted >= 5 * power ? 5 : wanted >= 2 * power ? 2 : 1), c = this.context;
    const y = box.height - 14, x = 14;
    c.strokeStyle = c.fillStyle = theme.colourOf('#222222');
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, y - 4); c.lineTo(x, y); c.lineTo(x + length * this.pixels, y); c.lineTo(x + length * this.pixels, y - 4);
    c.stroke();
    c.font = '12px sans-serif';
    c.fillText(`${length} m`, x + 4, y - 6);
  }
}
