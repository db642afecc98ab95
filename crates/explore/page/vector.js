// A canvas that writes what is drawn on it down as SVG: paths, dashes, text, of what the stage draws with. Ours, since
// the libraries for it have the whole of canvas and are not kept up; this is what the stage uses.

const number = (x) => String(Number(x.toFixed(2)));
const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

// A colour with its opacity apart, which not every program reads in one.
function paint(kind, colour) {
  const [, rgb, alpha] = /^(#[0-9a-f]{6})([0-9a-f]{2})$/i.exec(colour) ?? [null, colour, null];
  return `${kind}="${rgb}"${alpha ? ` ${kind}-opacity="${number(parseInt(alpha, 16) / 255)}"` : ""}`;
}

export class Vector {
  constructor(width, height, background) {
    Object.assign(this, { width, height, globalAlpha: 1, lineWidth: 1, lineCap: "butt", lineJoin: "round", dash: [], path: "" });
    this.parts = [`<rect width="${width}" height="${height}" ${paint("fill", background)}/>`];
  }

  setTransform() {}

  clearRect() {}

  beginPath() {
    this.path = "";
  }

  moveTo(x, y) {
    this.path += `M${number(x)} ${number(y)}`;
  }

  lineTo(x, y) {
    this.path += `L${number(x)} ${number(y)}`;
  }

  // A whole circle.
  arc(x, y, r) {
    const [left, right] = [number(x - r), number(x + r)];
    this.path += `M${left} ${number(y)}A${number(r)} ${number(r)} 0 1 1 ${right} ${number(y)}A${number(r)} ${number(r)} 0 1 1 ${left} ${number(y)}`;
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  fill() {
    this.put(`${paint("fill", this.fillStyle)}`);
  }

  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.map(number).join(" ")}"` : "";
    this.put(`fill="none" ${paint("stroke", this.strokeStyle)} stroke-width="${number(this.lineWidth)}" stroke-linecap="${this.lineCap}" stroke-linejoin="${this.lineJoin}"${dash}`);
  }

  put(look) {
    const alpha = this.globalAlpha < 1 ? ` opacity="${this.globalAlpha}"` : "";
    if (this.path) this.parts.push(`<path d="${this.path}" ${look}${alpha}/>`);
  }

  fillText(text, x, y) {
    const anchor = { left: "start", center: "middle", right: "end" }[this.textAlign];
    const [size] = /[\d.]+/.exec(this.font);
    this.parts.push(`<text x="${number(x)}" y="${number(y)}" font-family="sans-serif" font-size="${size}" text-anchor="${anchor}" ${paint("fill", this.fillStyle)}>${escape(text)}</text>`);
  }

  svg(title) {
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${this.width} ${this.height}" width="${this.width}" height="${this.height}" role="img"><title>${escape(title)}</title>\n${this.parts.join("\n")}\n</svg>\n`;
  }
}
