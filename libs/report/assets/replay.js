// The run again, step by step: robot, tracks, landmarks as they appear, field of view and what is in sight.

class Replay {
  constructor(element) {
    this.element = element;
    this.data = JSON.parse(element.querySelector('script.data').textContent);
    this.canvas = element.querySelector('canvas');
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
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    this.canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;
      event.preventDefault();
      this.enlarge(Math.exp(-0.002 * event.deltaY));
    }, {passive: false});
    this.canvas.addEventListener('pointerdown', (event) => { this.held = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('pointermove', (event) => this.drag(event));
    this.canvas.addEventListener('pointerup', () => { this.held = null; });
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

  wants(layer) {
    return this.element.querySelector(`input[value=${layer}]`).checked;
  }

  scale() {
    const {low, high} = this.data, box = this.canvas.getBoundingClientRect();
    return this.zoom * Math.min(box.width / (high[0] - low[0]), box.height / (high[1] - low[1]));
  }

  draw() {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    if (box.width === 0) return;
    this.canvas.width = Math.round(box.width * ratio);
    this.canvas.height = Math.round(box.height * ratio);
    if (this.wants('follow')) this.middle = [this.data.robot.x[this.frame], this.data.robot.y[this.frame]];
    const scale = this.scale();
    this.context = this.canvas.getContext('2d');
    this.context.scale(ratio, ratio);
    this.toX = (x) => (x - this.middle[0]) * scale + box.width / 2;
    this.toY = (y) => (this.middle[1] - y) * scale + box.height / 2;
    this.pixels = scale;
    this.drawTruth();
    if (this.wants('sight')) this.drawSight();
    this.drawLandmarks();
    this.drawTracks();
    this.drawRobot();
    this.drawScaleBar(box);
  }

  line(xs, ys, from, to, colour, width, opacity = 1) {
    const c = this.context;
    c.strokeStyle = theme.themed(colour);
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

  drawTruth() {
    if (!this.wants('truth')) return;
    const {truth, targets, trueLandmarks, colours} = this.data, c = this.context;
    c.strokeStyle = theme.themed(colours.trueLandmark);
    c.lineWidth = 1;
    c.beginPath();
    trueLandmarks.x.forEach((x, i) => {
      const px = this.toX(x), py = this.toY(trueLandmarks.y[i]);
      if (px < 0 || py < 0 || px > this.canvas.width || py > this.canvas.height) return;
      c.moveTo(px - 3, py - 3); c.lineTo(px + 3, py + 3);
      c.moveTo(px - 3, py + 3); c.lineTo(px + 3, py - 3);
    });
    c.stroke();
    if (truth) this.line(truth.x, truth.y, 0, this.frame + 1, colours.robot, 5, 0.35);
    for (const target of targets) this.line(target.x, target.y, 0, this.frame + 1, target.colour, 5, 0.35);
  }

  /** The sensors' fields of view, and lines to what was seen. */
  drawSight() {
    const {robot, sensors, seen, tracks, landmarks, colours} = this.data, c = this.context, i = this.frame;
    const [x, y, heading] = [robot.x[i], robot.y[i], robot.theta[i]];
    for (const sensor of sensors) {
      if (!(sensor.range > 0)) continue;
      const sx = x + sensor.x * Math.cos(heading) - sensor.y * Math.sin(heading);
      const sy = y + sensor.x * Math.sin(heading) + sensor.y * Math.cos(heading);
      const middle = -(heading + sensor.theta), whole = sensor.view > 6.28;
      c.beginPath();
      if (!whole) c.moveTo(this.toX(sx), this.toY(sy));
      c.arc(this.toX(sx), this.toY(sy), sensor.range * this.pixels, middle - sensor.view / 2, middle + sensor.view / 2);
      c.closePath();
      c.fillStyle = c.strokeStyle = theme.themed(colours.sight);
      c.globalAlpha = 0.1;
      c.fill();
      c.globalAlpha = 0.6;
      c.lineWidth = 1;
      c.stroke();
    }
    c.strokeStyle = theme.themed(colours.sight);
    c.globalAlpha = 0.7;
    c.beginPath();
    const known = new Map(this.knownLandmarks().map((row) => [landmarks.index[row], row]));
    for (const thing of seen[i] || []) {
      const row = known.get(thing), track = tracks[-1 - thing];
      const tx = track ? track.x[i - track.from] : landmarks.x[row];
      const ty = track ? track.y[i - track.from] : landmarks.y[row];
      if (tx === undefined || tx === null) continue;
      c.moveTo(this.toX(x), this.toY(y));
      c.lineTo(this.toX(tx), this.toY(ty));
    }
    c.stroke();
    c.globalAlpha = 1;
  }

  drawLandmarks() {
    const {landmarks, colours} = this.data, c = this.context, rows = this.knownLandmarks();
    c.fillStyle = c.strokeStyle = theme.themed(colours.landmark);
    for (const row of rows) {
      c.fillRect(this.toX(landmarks.x[row]) - 1.5, this.toY(landmarks.y[row]) - 1.5, 3, 3);
    }
    if (!this.wants('ellipses')) return;
    c.lineWidth = 0.8;
    c.globalAlpha = 0.6;
    c.beginPath();
    for (const row of rows) {
      if (landmarks.a[row] * this.pixels < 1.5) continue;  // beneath the mark
      this.ellipse(landmarks.x[row], landmarks.y[row], landmarks.a[row], landmarks.b[row], landmarks.angle[row]);
    }
    c.stroke();
    c.globalAlpha = 1;
  }

  drawTracks() {
    const c = this.context;
    for (const track of this.data.tracks) {
      const k = this.frame - track.from;
      if (k < 0) continue;
      this.line(track.x, track.y, 0, k + 1, track.colour, 1.6);
      if (track.x[k] === undefined || track.x[k] === null) continue;
      const mode = this.data.modes.length > 1 ? this.data.modes[track.mode[k]] : null;
      c.fillStyle = c.strokeStyle = theme.themed(mode ? mode.colour : track.colour);
      if (this.wants('ellipses')) {
        c.lineWidth = 1.2;
        c.beginPath();
        this.ellipse(track.x[k], track.y[k], track.a[k], track.b[k], track.angle[k]);
        c.stroke();
      }
      const px = this.toX(track.x[k]), py = this.toY(track.y[k]);
      c.beginPath();
      c.arc(px, py, 5, 0, 2 * Math.PI);
      c.fill();
      c.fillStyle = theme.themed('#222222');
      c.font = '12px sans-serif';
      c.fillText(mode ? `${track.name}: ${mode.name}` : track.name, px + 9, py - 7);
    }
  }

  drawRobot() {
    const {robot, colours} = this.data, c = this.context, i = this.frame;
    this.line(robot.x, robot.y, 0, i + 1, colours.robot, 1.6);
    c.strokeStyle = c.fillStyle = theme.themed(colours.robot);
    if (this.wants('ellipses')) {
      c.lineWidth = 1.2;
      c.beginPath();
      this.ellipse(robot.x[i], robot.y[i], robot.a[i], robot.b[i], robot.angle[i]);
      c.stroke();
    }
    const px = this.toX(robot.x[i]), py = this.toY(robot.y[i]), size = 11;
    c.beginPath();
    for (const [turn, reach] of [[0, 1], [2.5, 0.8], [Math.PI, 0.35], [-2.5, 0.8]]) {
      const angle = -(robot.theta[i] + turn);
      c.lineTo(px + size * reach * Math.cos(angle), py + size * reach * Math.sin(angle));
    }
    c.closePath();
    c.fill();
    c.strokeStyle = theme.colour('background');
    c.lineWidth = 1;
    c.stroke();
  }

  /** A round number of metres, about a sixth of the picture. */
  drawScaleBar(box) {
    const wanted = box.width / 6 / this.pixels, power = Math.pow(10, Math.floor(Math.log10(wanted)));
    const length = power * (wanted >= 5 * power ? 5 : wanted >= 2 * power ? 2 : 1), c = this.context;
    const y = box.height - 14, x = 14;
    c.strokeStyle = c.fillStyle = theme.themed('#222222');
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, y - 4); c.lineTo(x, y); c.lineTo(x + length * this.pixels, y); c.lineTo(x + length * this.pixels, y - 4);
    c.stroke();
    c.font = '12px sans-serif';
    c.fillText(`${length} m`, x + 4, y - 6);
  }
}
