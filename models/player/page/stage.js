// The panels: one for each take, all at one scale.

class Stage {
  constructor(section, show) {
    const extents = [];
    this.panels = show.takes.map((motion) => {
      const panel = makePanel(section, motion);
      if (motion.body) {
        panel.body = new BodyDrawing(motion);
        extents.push({ extent: panel.body.extent(), unit: motion.shoulder });
      }
      if (motion.curves) panel.head = new HeadDrawing(motion);
      return panel;
    });
    // In shoulder lengths, so that figures of different sizes can be compared.
    const most = (side, pick) => pick(...extents.map(({ extent, unit }) => extent[side] / unit));
    this.extent = extents.length === 0 ? null : {
      left: most("left", Math.min), right: most("right", Math.max),
      top: most("top", Math.min), bottom: most("bottom", Math.max),
    };
    this.hasBody = show.takes.some((motion) => motion.body);
    this.closeUp = false;
    this.trails = true;
  }

  resize() {
    for (const panel of this.panels) fitCanvas(panel.canvas);
  }

  draw(time, palette) {
    for (const panel of this.panels) {
      const { canvas, motion } = panel, context = canvas.getContext("2d");
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, canvas.width, canvas.height);
      if (panel.body) {
        this.placeBody(context, canvas, motion.shoulder, panel.body, time);
        panel.body.draw(context, time, palette, { trails: this.trails && !this.closeUp, closeUp: this.closeUp });
      }
      if (panel.head) {
        placeHead(context, canvas, panel.body !== undefined);
        panel.head.draw(context, time, palette);
      }
    }
  }

  placeBody(context, canvas, unit, body, time) {
    let { left, right, top, bottom } = this.extent;
    if (this.closeUp) {
      const head = body.headOf(body.motion.body.at(body.motion, time));
      const [x, y] = head ? [head.centre[0] / unit, head.centre[1] / unit] : [0, -0.9];
      [left, right, top, bottom] = [x - 0.62, x + 0.62, y - 0.66, y + 0.66];
    }
    const pad = 0.05 * Math.min(canvas.width, canvas.height);
    // In a narrow panel the head is where the panel's name stands.
    const name = this.panels.length > 1 && canvas.clientWidth < 320 ? 30 * canvas.width / canvas.clientWidth : pad;
    const scale = Math.min((canvas.width - 2 * pad) / (right - left),
                           (canvas.height - pad / 2 - name) / (bottom - top));
    // The torso fades out at the lower edge of the panel.
    const x = canvas.width / 2 - scale * (left + right) / 2;
    const y = this.closeUp ? canvas.height / 2 - scale * (top + bottom) / 2
      : canvas.height - pad / 2 - scale * bottom;
    context.setTransform(scale / unit, 0, 0, scale / unit, x, y);
  }
}

function placeHead(context, { width, height }, beside) {
  const scale = Math.min(width / 3.4, height / 3.4) * (beside ? 0.4 : 1);
  context.setTransform(scale, 0, 0, scale, beside ? width - 1.7 * scale : width / 2,
                       beside ? 1.4 * scale : height * 0.5 - 0.28 * scale);
}

function makePanel(section, motion) {
  const panel = document.createElement("figure"), canvas = document.createElement("canvas");
  const caption = document.createElement("figcaption");
  panel.className = "panel " + motion.role;
  canvas.setAttribute("role", "img");
  const parts = [];
  if (motion.body) parts.push(`a body of ${motion.body.names.length} points`);
  if (motion.face) parts.push(`a face of ${motion.face.names.length} points`);
  if (motion.curves) parts.push("a head moved by " + motion.curves.map((curve) => curve.name).join(", "));
  canvas.setAttribute("aria-label", `${motion.label}: ${parts.join(", ")}`);
  caption.textContent = motion.label;
  panel.append(canvas, caption);
  section.append(panel);
  return { canvas, motion };
}

// Gives a canvas as many pixels as the screen has in its place; whether that changed it.
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
  if (canvas.width === width && canvas.height === height) return false;
  canvas.width = width;
  canvas.height = height;
  return true;
}
