// The timeline: seconds, rows, the region that is looped, and the line that stands at the time shown.

const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
const UNLABELLED = new Set(["Sound", "Words"]);  // on small screens, where these speak for themselves
const RULER = 24, OVERVIEW = 26, GAP = 6;

class Timeline {
  constructor(canvas, show) {
    this.canvas = canvas;
    this.show = show;
    this.seconds = show.seconds;
    this.back = document.createElement("canvas");  // all that does not move
    this.begin = 0;
    this.end = 0;  // of what is in view; 0: not chosen yet
    this.loop = null;  // {begin, end}
    this.stale = true;
    this.onSeek = this.onLoop = () => {};
    canvas.addEventListener("pointerdown", (event) => this.press(event));
  }

  get span() { return this.end - this.begin; }
  get zoomed() { return this.span < this.seconds - 1e-6; }

  layout() {
    const width = this.canvas.clientWidth;
    this.small = width < 560;
    this.left = this.small ? 0 : 150;
    this.right = width - (this.small ? 0 : 8);
    if (this.end === 0) {  // words need about so much room
      const seconds = (this.right - this.left) / 80;
      this.end = this.seconds > 1.4 * seconds ? seconds : this.seconds;
    }
    this.lanes = lanesOf(this.show, (this.right - this.left) / this.span);
    this.rows = tracksOf(this.show, this.small, this.stretch(), this.lanes);
    let y = RULER + (this.zoomed ? OVERVIEW + GAP : 0);
    for (const row of this.rows) {
      row.room = this.small && !UNLABELLED.has(row.label) ? 13 : 0;  // for the label above it
      row.y = y + row.room;
      y = row.y + row.height + GAP;
    }
    this.height = y;
    this.canvas.style.height = `${y}px`;
    fitCanvas(this.canvas);
    this.stale = true;
  }

  // How much higher rows become where the panel beside them leaves room.
  stretch() {
    const stage = document.getElementById("stage").getBoundingClientRect();
    const beside = stage.right < this.canvas.getBoundingClientRect().left;
    if (!beside) return 1;
    const high = (stretch) => tracksOf(this.show, this.small, stretch, this.lanes)
      .reduce((sum, row) => sum + row.height + GAP, RULER);
    const plain = high(1), twice = high(2);  // words do not grow
    return Math.min(Math.max(1 + (stage.height - 24 - plain) / Math.max(twice - plain, 1), 1), 2);
  }

  // What rows draw with, for the seconds in view or for all of them.
  view(whole = false) {
    const begin = whole ? 0 : this.begin, end = whole ? this.seconds : this.end;
    const { left, right } = this;
    const scale = (right - left) / Math.max(end - begin, 1e-6);
    return { left, right, begin, end, x: (time) => left + (time - begin) * scale };
  }

  timeAt(x, whole = false) {
    const { begin, end } = this.view(whole);
    const time = begin + (x - this.left) / (this.right - this.left) * (end - begin);
    return Math.min(Math.max(time, 0), this.seconds);
  }

  // Shows `factor` times as much time, around `time`.
  zoom(factor, time) {
    const span = Math.min(Math.max(this.span * factor, Math.min(0.5, this.seconds)), this.seconds);
    const share = Math.min(Math.max((time - this.begin) / this.span, 0), 1);
    this.setView(time - share * span, span);
  }

  setView(begin, span) {
    const wasZoomed = this.zoomed;
    this.begin = Math.min(Math.max(begin, 0), Math.max(this.seconds - span, 0));
    this.end = this.begin + span;
    this.stale = true;
    if (this.zoomed !== wasZoomed) this.layout();
  }

  // Turns the page when `time` leaves it.
  follow(time, playing) {
    const edge = playing ? 0.94 : 1;
    if (time < this.begin - 1e-6 || (time > this.begin + edge * this.span + 1e-6 && this.end < this.seconds - 1e-6))
      this.setView(time - 0.06 * this.span, this.span);
  }

  setLoop(loop) {
    this.loop = loop && loop.end - loop.begin >= 0.05 ? loop : null;
  }

  press(event) {
    if (event.button !== 0) return;
    const box = this.canvas.getBoundingClientRect(), y = event.clientY - box.top;
    const overview = this.zoomed && y >= RULER && y < RULER + OVERVIEW, ruler = y < RULER;
    const at = (move) => this.timeAt(move.clientX - box.left, overview);
    const anchor = at(event);
    const drag = (move) => {
      if (ruler) this.onLoop({ begin: Math.min(anchor, at(move)), end: Math.max(anchor, at(move)) });
      else this.onSeek(at(move));
    };
    if (!ruler) drag(event);
    const release = (last) => {
      this.canvas.removeEventListener("pointermove", drag);
      if (ruler && last.type === "pointerup" && Math.abs(at(last) - anchor) < 0.05) this.onSeek(anchor);
    };
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.addEventListener("pointermove", drag);
    this.canvas.addEventListener("pointerup", release, { once: true });
    this.canvas.addEventListener("pointercancel", release, { once: true });
  }

  draw(time, palette, looping) {
    if (fitCanvas(this.canvas) || this.stale) this.drawBack(palette);
    const context = this.canvas.getContext("2d"), ratio = this.canvas.width / this.canvas.clientWidth;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    if (this.loop) this.drawLoop(context, ratio, palette, looping);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.back, 0, 0);
    const view = this.view();
    for (const row of this.rows) {
      context.setTransform(ratio, 0, 0, ratio, 0, ratio * row.y);
      context.textBaseline = "middle";
      if (row.drawNow) this.clipped(context, row.height, () => row.drawNow(context, view, palette, time));
      this.drawValue(context, row, row.value(time), palette);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawHand(context, view.x(time), palette);
    if (this.zoomed) {
      context.fillStyle = palette.accent;
      context.fillRect(this.view(true).x(time) - 0.75, RULER, 1.5, OVERVIEW);
    }
  }

  clipped(context, height, draw) {
    context.save();
    context.beginPath();
    context.rect(this.left, 0, this.right - this.left, height);
    context.clip();
    draw();
    context.restore();
  }

  drawBack(palette) {
    this.stale = false;
    this.back.width = this.canvas.width;
    this.back.height = this.canvas.height;
    const context = this.back.getContext("2d"), ratio = this.canvas.width / this.canvas.clientWidth;
    const view = this.view();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.textBaseline = "middle";
    this.drawRuler(context, view, palette);
    this.drawSeams(context, view, palette);
    if (this.zoomed) this.drawOverview(context, ratio, palette);
    for (const row of this.rows) {
      context.setTransform(ratio, 0, 0, ratio, 0, ratio * row.y);
      this.clipped(context, row.height, () => row.draw(context, view, palette));
      this.drawLabel(context, row, palette);
    }
  }

  drawLabel(context, row, palette) {
    context.textAlign = "start";
    if (this.small) {
      context.font = `600 10.5px ${FONT}`;
      const text = [row.label, row.detail].filter((part) => part).join(row.detail.startsWith("and") ? " " : ", ");
      context.fillStyle = palette.muted;
      if (!UNLABELLED.has(row.label)) context.fillText(text, 2, -6);
      return;
    }
    const middle = row.height / 2;
    context.fillStyle = palette.ink;
    context.font = `600 12px ${FONT}`;
    context.fillText(row.label, 0, row.detail ? middle - 7 : middle);
    context.fillStyle = palette.muted;
    context.font = `11px ${FONT}`;
    context.fillText(row.detail, 0, middle + 8);
  }

  drawValue(context, row, value, palette) {
    if (!value) return;
    context.textAlign = "end";
    context.font = `600 ${this.small ? 10.5 : 12}px ${FONT}`;
    context.fillStyle = palette.accent;
    if (this.small) context.fillText(value, this.right - 2, -6);
    else context.fillText(value, this.left - 12, row.height / 2);
  }

  drawRuler(context, view, palette) {
    const room = 64 * this.span / (view.right - view.left);
    const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600];
    const step = steps.find((one) => one >= room) ?? 1200;
    context.font = `11px ${FONT}`;
    context.textAlign = "start";
    for (let i = Math.ceil(this.begin / step - 1e-6); i * step <= this.end + 1e-6; ++i) {
      const x = view.x(i * step);
      context.fillStyle = palette.line;
      context.fillRect(Math.round(x), 4, 1, this.height - GAP);
      context.fillStyle = palette.muted;
      if (x < view.right - 34) context.fillText(clockText(i * step, step < 1 ? 1 : 0), x + 8, 9);  // beside the hand
    }
  }

  drawSeams(context, view, palette) {
    const { seams, rate } = this.show.prediction;
    if (seams.length > 1.5 * this.seconds) return;  // word by word, which the words show already
    context.fillStyle = palette.muted;
    for (const seam of seams) {
      const x = Math.round(view.x(seam / rate));
      if (x < view.left || x > view.right) continue;
      for (let y = RULER; y < this.height - GAP; y += 5) context.fillRect(x, y, 1, 1.5);
    }
  }

  drawOverview(context, ratio, palette) {
    const whole = this.view(true), wave = this.rows.find((row) => row.label === "Sound");
    context.fillStyle = palette.word;
    context.beginPath();
    context.roundRect(whole.left, RULER, whole.right - whole.left, OVERVIEW, 5);
    context.fill();
    if (wave) {
      context.save();
      context.translate(0, RULER);
      context.scale(1, OVERVIEW / wave.height);
      wave.draw(context, whole, palette);
      context.restore();
    }
    context.strokeStyle = palette.accent;
    context.lineWidth = 1.5;
    context.beginPath();
    const x = whole.x(this.begin);
    context.roundRect(x + 0.75, RULER + 0.75, Math.max(whole.x(this.end) - x - 1.5, 3), OVERVIEW - 1.5, 5);
    context.stroke();
  }

  drawLoop(context, ratio, palette, looping) {
    const view = this.view();
    const from = Math.max(view.x(this.loop.begin), view.left), to = Math.min(view.x(this.loop.end), view.right);
    if (to <= from) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = palette.accent;
    context.globalAlpha = looping ? 0.16 : 0.07;
    context.fillRect(from, 0, to - from, this.height - GAP);
    context.globalAlpha = looping ? 1 : 0.5;
    context.fillRect(from, 0, to - from, 3);
    context.globalAlpha = 1;
  }

  drawHand(context, x, palette) {
    if (x < this.left - 1 || x > this.right + 1) return;
    const at = Math.min(Math.max(x, this.left + 0.75), this.right - 0.75);
    context.fillStyle = palette.accent;
    context.fillRect(at - 0.75, 4, 1.5, this.height - GAP - 4);
    context.beginPath();
    context.moveTo(at - 6, 0);
    context.lineTo(at + 6, 0);
    context.lineTo(at + 6, 8);
    context.lineTo(at, 15);
    context.lineTo(at - 6, 8);
    context.closePath();
    context.fill();
  }
}

// "1:02", with `digits` of its seconds behind the point.
function clockText(seconds, digits) {
  const scale = 10 ** digits, whole = Math.round(seconds * scale);
  const minutes = Math.floor(whole / (60 * scale)), rest = ((whole - minutes * 60 * scale) / scale).toFixed(digits);
  return `${minutes}:${rest.padStart(digits > 0 ? digits + 3 : 2, "0")}`;
}
