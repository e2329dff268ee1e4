'use strict';
/**
 * The colour scale of deviations, and colours of a theme.
 *
 * Small deviations are blue, large ones yellow (dark ground) or dark red (light ground); the lightness runs one way,
 * away from the ground, so that the scale reads without colour vision and on a grey printer. It is interpolated in
 * OKLab between a few points. Source: B. Ottosson, "A perceptual color space for image processing", 2020.
 */
(() => {
  /** Points of the scale: [fraction, lightness 0..1, chroma, hue in degrees]. */
  const onLight = [[0, 0.78, 0.11, 232], [0.3, 0.66, 0.14, 258], [0.55, 0.55, 0.19, 318], [0.8, 0.44, 0.17, 10],
    [1, 0.29, 0.11, 28]];
  const onDark = [[0, 0.48, 0.14, 264], [0.3, 0.59, 0.11, 225], [0.55, 0.71, 0.14, 158], [0.8, 0.83, 0.17, 115],
    [1, 0.96, 0.13, 103]];

  const fromLinear = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  const toLinear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const clamp = (v) => Math.min(1, Math.max(0, v));

  /** sRGB 0..1 of a colour in OKLab. */
  function rgbOfLab([L, a, b]) {
    const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (L - 0.0894841775 * a - 1.2914855480 * b) ** 3;
    return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
      -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
      -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s].map((v) => clamp(fromLinear(clamp(v))));
  }

  function labOfPoint([, L, chroma, hue]) {
    const angle = (hue * Math.PI) / 180;
    return [L, chroma * Math.cos(angle), chroma * Math.sin(angle)];
  }

  /** The colour, sRGB 0..1, of a deviation that is `fraction` of the largest. Beyond 0..1: the colour of the end. */
  function at(fraction, dark) {
    const points = dark ? onDark : onLight;
    const x = clamp(fraction);
    let i = 1;
    while (i < points.length - 1 && x > points[i][0]) ++i;
    const t = (x - points[i - 1][0]) / (points[i][0] - points[i - 1][0]);
    const from = labOfPoint(points[i - 1]);
    const to = labOfPoint(points[i]);
    return rgbOfLab(from.map((v, k) => v + t * (to[k] - v)));
  }

  /** "rgb(1, 2, 3)" of sRGB 0..1. */
  const css = (rgb) => `rgb(${rgb.map((v) => Math.round(255 * v)).join(', ')})`;

  /** The scale in `size` steps as bytes r, g, b, 255: for a texture or a table. */
  function table(size, dark) {
    const bytes = new Uint8Array(4 * size);
    for (let i = 0; i < size; ++i)
      bytes.set([...at(i / (size - 1), dark).map((v) => Math.round(255 * v)), 255], 4 * i);
    return bytes;
  }

  /** Relative luminance 0..1 of sRGB 0..1. Source: WCAG 2.1. */
  const luminance = ([r, g, b]) => 0.2126 * toLinear(r) + 0.7152 * toLinear(g) + 0.0722 * toLinear(b);

  /** Contrast 1..21 of two colours. Source: WCAG 2.1. */
  function contrast(one, other) {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  }

  /** sRGB 0..1 of "#abc", "#aabbcc" or "rgb(1, 2, 3)"; null for other texts. */
  function parse(text) {
    const hex = /^#([0-9a-f]{3}|[0-9a-f]{6})$/i.exec(text.trim());
    if (hex) {
      const digits = hex[1].length === 3 ? hex[1].replace(/./g, '$&$&') : hex[1];
      return [0, 2, 4].map((i) => parseInt(digits.slice(i, i + 2), 16) / 255);
    }
    const rgb = /^rgba?\(\s*([\d.]+)[\s,]+([\d.]+)[\s,]+([\d.]+)/i.exec(text.trim());
    return rgb ? rgb.slice(1, 4).map((v) => clamp(Number(v) / 255)) : null;
  }

  /** The colours for white paper, for any theme of the screen. */
  const paper = {ground: [1, 1, 1], ink: [0.1, 0.1, 0.1], muted: [0.4, 0.4, 0.4], dark: false};

  /** The colours of an element's theme: its properties --ground, --ink, --muted; those of paper where missing. */
  function themeOf(element) {
    const style = getComputedStyle(element);
    const colour = (name) => parse(style.getPropertyValue(name)) || paper[name.slice(2)];
    const theme = {ground: colour('--ground'), ink: colour('--ink'), muted: colour('--muted')};
    return {...theme, dark: luminance(theme.ground) < 0.18};
  }

  counterflex.colours = {at, css, table, luminance, contrast, parse, paper, themeOf};
})();
