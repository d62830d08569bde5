// How each layer of the replay is drawn at its present frame, from the data that ReplayLayers.cpp gives it. A layer is an
// entry here and one there.

/** Of something that exists with this probability [%]: what hardly does is still seen. */
function opacityOf(existence) { return 0.25 + 0.75 * existence / 100; }

const replayLayers = {
  truth(replay, {robot, targets, landmarks}) {
    const {colours} = replay.data, c = replay.context;
    c.strokeStyle = theme.colourOf(colours.trueLandmark);
    c.lineWidth = 1;
    c.beginPath();
    landmarks.x.forEach((x, i) => {
      const px = replay.toX(x), py = replay.toY(landmarks.y[i]);
      if (px < 0 || py < 0 || px > replay.box.width || py > replay.box.height) return;
      c.moveTo(px - 3, py - 3); c.lineTo(px + 3, py + 3);
      c.moveTo(px - 3, py + 3); c.lineTo(px + 3, py - 3);
    });
    c.stroke();
    replay.line(robot.x, robot.y, 0, replay.frame + 1, colours.robot, 5, 0.35);
    for (const target of targets) replay.line(target.x, target.y, 0, replay.frame + 1, target.colour, 5, 0.35);
  },

  /** The sensors' fields of view, and lines to what was seen. */
  sight(replay, {sensors, seen}) {
    const {robot, tracks, landmarks, colours} = replay.data, c = replay.context, i = replay.frame;
    const [x, y, heading] = [robot.x[i], robot.y[i], robot.theta[i]];
    for (const sensor of sensors) {
      if (!(sensor.range > 0)) continue;
      const sx = x + sensor.x * Math.cos(heading) - sensor.y * Math.sin(heading);
      const sy = y + sensor.x * Math.sin(heading) + sensor.y * Math.cos(heading);
      const middle = -(heading + sensor.theta), whole = sensor.view > 6.28;
      c.beginPath();
      if (!whole) c.moveTo(replay.toX(sx), replay.toY(sy));
      c.arc(replay.toX(sx), replay.toY(sy), sensor.range * replay.pixels, middle - sensor.view / 2, middle + sensor.view / 2);
      c.closePath();
      c.fillStyle = c.strokeStyle = theme.colourOf(colours.sight);
      c.globalAlpha = 0.1;
      c.fill();
      c.globalAlpha = 0.6;
      c.lineWidth = 1;
      c.stroke();
    }
    c.strokeStyle = theme.colourOf(colours.sight);
    c.globalAlpha = 0.7;
    c.beginPath();
    const known = new Map(replay.knownLandmarks().map((row) => [landmarks.index[row], row]));
    for (const thing of seen[i] || []) {
      const row = known.get(thing), track = tracks[-1 - thing];
      const tx = track ? track.x[i - track.from] : landmarks.x[row];
      const ty = track ? track.y[i - track.from] : landmarks.y[row];
      if (tx === undefined || tx === null) continue;
      c.moveTo(replay.toX(x), replay.toY(y));
      c.lineTo(replay.toX(tx), replay.toY(ty));
    }
    c.stroke();
    c.globalAlpha = 1;
  },

  landmarks(replay, landmarks) {
    const {colours} = replay.data, c = replay.context, rows = replay.knownLandmarks();
    c.fillStyle = c.strokeStyle = theme.colourOf(colours.landmark);
    for (const row of rows) {
      if (landmarks.existence) c.globalAlpha = opacityOf(landmarks.existence[row]);
      c.fillRect(replay.toX(landmarks.x[row]) - 1.5, replay.toY(landmarks.y[row]) - 1.5, 3, 3);
    }
    c.globalAlpha = 1;
    if (!replay.wants('ellipses')) return;
    c.lineWidth = 0.8;
    c.globalAlpha = 0.6;
    c.beginPath();
    for (const row of rows) {
      if (landmarks.a[row] * replay.pixels < 1.5) continue;  // beneath the mark
      replay.ellipse(landmarks.x[row], landmarks.y[row], landmarks.a[row], landmarks.b[row], landmarks.angle[row]);
    }
    c.stroke();
    c.globalAlpha = 1;
  },

  tentative(replay, {from, to, x, y, existence}) {
    const c = replay.context, i = replay.frame;
    c.strokeStyle = theme.colourOf(replay.data.colours.landmark);
    c.lineWidth = 1;
    for (let k = 0; k < from.length; ++k) {
      if (i < from[k] || i >= to[k]) continue;
      c.globalAlpha = opacityOf(existence[k]);
      c.strokeRect(replay.toX(x[k]) - 3, replay.toY(y[k]) - 3, 6, 6);
    }
    c.globalAlpha = 1;
  },

  tracks(replay, tracks) {
    const c = replay.context;
    for (const track of tracks) {
      const k = replay.frame - track.from;
      if (k < 0) continue;
      replay.line(track.x, track.y, 0, k + 1, track.colour, 1.6);
      if (track.x[k] === undefined || track.x[k] === null) continue;
      const mode = replay.data.modes.length > 1 ? replay.data.modes[track.mode[k]] : null;
      c.fillStyle = c.strokeStyle = theme.colourOf(mode ? mode.colour : track.colour);
      if (replay.wants('ellipses')) {
        c.lineWidth = 1.2;
        c.beginPath();
        replay.ellipse(track.x[k], track.y[k], track.a[k], track.b[k], track.angle[k]);
        c.stroke();
      }
      const px = replay.toX(track.x[k]), py = replay.toY(track.y[k]);
      c.beginPath();
      c.arc(px, py, 5, 0, 2 * Math.PI);
      c.fill();
      c.fillStyle = theme.colourOf('#222222');
      c.font = '12px sans-serif';
      c.fillText(mode ? `${track.name}: ${mode.name}` : track.name, px + 9, py - 7);
    }
  },

  /** A dot for each, with a tick where it is headed. */
  particles(replay, {first, unit, x, y, theta, weight}) {
    const {robot, colours} = replay.data, c = replay.context, i = replay.frame, tick = 8;
    c.strokeStyle = c.fillStyle = theme.colourOf(colours.particle);
    c.lineWidth = 1;
    for (let k = first[i]; k < first[i + 1]; ++k) {
      const px = replay.toX(robot.x[i] + unit * x[k]), py = replay.toY(robot.y[i] + unit * y[k]);
      c.globalAlpha = 0.2 + 0.8 * weight[k] / 9;
      c.beginPath();
      c.arc(px, py, 1.8, 0, 2 * Math.PI);
      c.fill();
      c.beginPath();
      c.moveTo(px, py);
      c.lineTo(px + tick * Math.cos(theta[k] / 100), py - tick * Math.sin(theta[k] / 100));
      c.stroke();
    }
    c.globalAlpha = 1;
  },

  robot(replay, robot) {
    const {colours} = replay.data, c = replay.context, i = replay.frame;
    replay.line(robot.x, robot.y, 0, i + 1, colours.robot, 1.6);
    c.strokeStyle = c.fillStyle = theme.colourOf(colours.robot);
    if (replay.wants('ellipses')) {
      c.lineWidth = 1.2;
      c.beginPath();
      replay.ellipse(robot.x[i], robot.y[i], robot.a[i], robot.b[i], robot.angle[i]);
      c.stroke();
    }
    const px = replay.toX(robot.x[i]), py = replay.toY(robot.y[i]), size = 11;
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
  },
};
