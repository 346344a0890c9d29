// The rows of the timeline: what each shows, how high it is, and how it is drawn.
//
// A row's draw(context, view) paints between view.left and view.right, from 0 to its height;
// view.x(seconds) is the place of a time.

const CURVE_NAMES = {
  AU01: "inner brow", AU02: "outer brow", AU04: "brow down", AU05: "upper lid", AU06: "cheek",
  AU07: "lid tight", Rx: "nod", Ry: "turn", Rz: "tilt",
};

function tracksOf(show, small, stretch, lanes) {
  const rows = [], high = (wide, narrow) => Math.round(small ? narrow : wide * stretch);
  if (show.levels) rows.push(waveRow(show, high(52, 44)));
  if (show.spectrogram) rows.push(spectrogramRow(show, high(68, 52)));
  if (show.words.length > 0) rows.push(wordRow(show, lanes));
  for (const name of curveNames(show)) rows.push(curveRow(show, name, high(38, 36)));
  if (show.takes.some((motion) => motion.body)) {
    rows.push(wristRow(show, "RWrist", "Right wrist", high(46, 40)));
    rows.push(wristRow(show, "LWrist", "Left wrist", high(46, 40)));
  }
  return rows.filter((row) => row !== null);
}

function curveNames(show) {
  const names = new Set();
  for (const motion of show.takes) for (const curve of motion.curves ?? []) names.add(curve.name);
  return names;
}

function waveRow({ levels }, height) {
  const loudest = Math.max(16, levels.peak.reduce((a, b) => Math.max(a, b), 0));
  const band = (context, view, values) => {
    const middle = height / 2, reach = (height / 2 - 2) / loudest;
    const begin = Math.max(0, Math.floor(view.begin * levels.rate));
    const end = Math.min(values.length, Math.ceil(view.end * levels.rate) + 1);
    const step = Math.max(1, Math.floor((end - begin) / (2 * (view.right - view.left))));
    const edge = [];
    for (let i = begin; i < end; i += step) {
      let most = 0;
      for (let j = i; j < Math.min(i + step, end); ++j) most = Math.max(most, values[j]);
      edge.push([view.x((i + 0.5) / levels.rate), Math.max(most * reach, 0.5)]);
    }
    context.beginPath();
    for (const [x, reached] of edge) context.lineTo(x, middle - reached);
    for (const [x, reached] of edge.reverse()) context.lineTo(x, middle + reached);
    context.fill();
  };
  return {
    label: "Sound", detail: "", height,
    draw(context, view, palette) {
      context.fillStyle = palette.wave;
      context.globalAlpha = 0.4;
      band(context, view, levels.peak);
      context.globalAlpha = 1;
      band(context, view, levels.rms);
    },
    value: () => "",
  };
}

function spectrogramRow({ spectrogram, pitch }, height) {
  const { bins, values, rate } = spectrogram, rows = values.length / bins;
  let picture = null, colour = "";
  const paint = (palette) => {
    picture = new OffscreenCanvas(rows, bins);
    const image = new ImageData(rows, bins), [r, g, b] = rgbOf(palette.spectrum);
    for (let row = 0; row < rows; ++row) {
      for (let bin = 0; bin < bins; ++bin) {
        image.data.set([r, g, b, values[row * bins + bin]], 4 * ((bins - 1 - bin) * rows + row));
      }
    }
    picture.getContext("2d").putImageData(image, 0, 0);
    colour = palette.spectrum;
  };
  return {
    label: "Spectrum", detail: pitch ? "and pitch" : "mel bands", height,
    draw(context, view, palette) {
      if (colour !== palette.spectrum) paint(palette);
      context.drawImage(picture, view.x(0), 1, view.x(rows / rate) - view.x(0), height - 2);
      if (pitch) drawPitch(context, view, palette, pitch, height);
    },
    value: (time) => {
      const hz = pitch ? pitch.hz[Math.floor(time * pitch.rate)] : 0;
      return hz > 0 ? `${hz.toFixed(0)} Hz` : "";
    },
  };
}

// From 50 to 500 Hz by octaves; a gap where there is no voice.
function drawPitch(context, view, palette, { hz, rate }, height) {
  const y = (value) => height - 4 - (height - 8) * Math.min(Math.max(Math.log2(value / 50) / Math.log2(10), 0), 1);
  context.strokeStyle = palette.pitch;
  context.lineWidth = 1.8;
  context.beginPath();
  const begin = Math.max(0, Math.floor(view.begin * rate)), end = Math.min(hz.length, Math.ceil(view.end * rate));
  for (let i = begin; i < end; ++i) {
    if (hz[i] <= 0) continue;
    if (i > begin && hz[i - 1] > 0) context.lineTo(view.x(i / rate), y(hz[i]));
    else context.moveTo(view.x(i / rate), y(hz[i]));
  }
  context.stroke();
}

const WORD = 11;  // pixels between a word and its next, and at its edges, that it can be read

// Words take turns in `lanes`, so that each may be as wide as its letters until the next in its lane.
function wordRow({ words }, lanes) {
  const high = lanes > 1 ? 19 : 22, height = 6 + lanes * (high + 2) - 2;
  const fit = (context, text, room) => [12, 10.5].some((size) => {
    context.font = `${size}px ${FONT}`;
    return context.measureText(text).width + 6 <= room;
  });
  return {
    label: "Words", detail: "", height,
    draw(context, view, palette) {
      for (let i = 0; i < words.length; ++i) this.drawWord(context, view, palette, i, false);
    },
    drawNow(context, view, palette, time) {
      const now = wordAt(words, time);
      if (now >= 0) this.drawWord(context, view, palette, now, true);
    },
    drawWord(context, view, palette, i, now) {
      const [text, start, end] = words[i], y = 3 + i % lanes * (high + 2), next = words[i + lanes];
      let x = view.x(start);
      const own = Math.max(view.x(end) - x - 2, 2), room = next ? view.x(next[1]) - x - 2 : view.right - x - 2;
      if (x + Math.max(own, room) < view.left || x > view.right) return;
      const fits = fit(context, text, now ? Infinity : Math.max(own, room));
      const width = fits ? Math.max(own, context.measureText(text).width + 6) : Math.max(own, room);
      if (now) x = Math.max(Math.min(x, view.right - width - 1), view.left);  // all of it, whatever it covers
      context.fillStyle = now ? palette.accent : palette.word;
      context.beginPath();
      context.roundRect(x + 1, y, width, high, 4);
      context.fill();
      if (!fits && width < 26) return;  // a letter or two would say nothing; the caption has it all
      context.save();
      context.clip();
      context.fillStyle = now ? palette.onAccent : palette.ink;
      context.textAlign = fits ? "center" : "start";
      context.direction = "inherit";
      context.fillText(text, fits ? x + 1 + width / 2 : x + 4, y + high / 2 + 0.5);
      context.restore();
    },
    value: () => "",
  };
}

// How many lanes words need that shall be read at `scale` pixels a second.
function lanesOf({ words, seconds }, scale) {
  const letters = words.reduce((sum, [text]) => sum + text.length, 0);
  return 6.5 * letters + WORD * words.length > 0.85 * scale * seconds ? 2 : 1;
}

// Lines of all takes, that of the prediction on top.
function drawLines(context, view, palette, takes, valuesOf, y) {
  const order = [...takes].sort((a, b) => (a.role === "prediction") - (b.role === "prediction"));
  for (const motion of order) {
    const values = valuesOf(motion);
    if (!values) continue;
    const begin = Math.max(0, Math.floor(view.begin * motion.rate));
    const end = Math.min(values.length - 1, Math.ceil(view.end * motion.rate));
    context.strokeStyle = palette[motion.role];
    context.lineWidth = motion.role === "prediction" ? 1.8 : 1.3;
    context.lineJoin = "round";
    context.beginPath();
    for (let frame = begin; frame <= end; ++frame) context.lineTo(view.x(frame / motion.rate), y(values[frame]));
    if (begin === end) context.lineTo(view.x(begin / motion.rate) + 2, y(values[begin]));
    context.stroke();
  }
}

function curveRow({ takes, prediction }, name, height) {
  const curveOf = (motion) => (motion.curves ?? []).find((curve) => curve.name === name);
  const curves = takes.map(curveOf).filter((curve) => curve);
  const angle = curves[0].unit === "rad", all = curves.flatMap((curve) => Array.from(curve.values));
  const reach = all.reduce((a, b) => Math.max(a, Math.abs(b)), angle ? 0.1 : 0);
  const low = angle ? -reach : Math.min(0, ...curves.map((curve) => curve.minimum));
  const high = angle ? reach : Math.max(Math.min(reach * 1.1, curves[0].maximum || reach), low + 1);
  const y = (value) => height - 5 - (height - 10) * (Math.min(Math.max(value, low), high) - low) / (high - low);
  const shown = curveOf(prediction) ? prediction : takes.find(curveOf);
  return {
    label: name, detail: CURVE_NAMES[name] ?? "", height, takes,
    draw(context, view, palette) {
      drawRule(context, view, palette, y(0));
      drawLines(context, view, palette, takes, (motion) => curveOf(motion)?.values, y);
    },
    value: (time) => {
      const value = curveOf(shown).at(shown, time);
      return angle ? `${(value * 180 / Math.PI).toFixed(0)}°` : value.toFixed(1);
    },
  };
}

function wristRow({ takes, prediction }, joint, label, height) {
  const speeds = new Map();
  for (const motion of takes) {
    const point = motion.body ? motion.body.byName.get(joint) : undefined;
    if (point === undefined) continue;
    const unit = motion.normalised ? motion.shoulder : 1;
    speeds.set(motion, speedOf(motion, point).map((speed) => speed / unit));
  }
  if (speeds.size === 0) return null;
  const sorted = Float32Array.from([...speeds.values()].flatMap((values) => Array.from(values))).sort();
  const high = Math.max(sorted[Math.round(0.99 * (sorted.length - 1))] * 1.1, 0.2);
  const y = (value) => height - 5 - (height - 9) * Math.min(value, high) / high;
  const shown = speeds.has(prediction) ? prediction : speeds.keys().next().value;
  return {
    label, detail: shown.normalised ? "shoulder lengths/s" : "pixels/s", height, takes,
    draw(context, view, palette) {
      drawRule(context, view, palette, y(0));
      drawLines(context, view, palette, takes, (motion) => speeds.get(motion), y);
    },
    value: (time) => {
      const values = speeds.get(shown), { before, after, share } = between(shown, time);
      const speed = values[before] + share * (values[after] - values[before]);
      return speed.toFixed(shown.normalised ? 1 : 0);
    },
  };
}

function drawRule(context, view, palette, y) {
  context.fillStyle = palette.line;
  context.fillRect(view.left, Math.round(y), view.right - view.left, 1);
}

// The parts of "#rrggbb".
function rgbOf(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}
