'use strict';
/** Points on the arcs of a path. The data have only the ends of stretches, and the direction of the path there. */
(() => {
  const step = (3 * Math.PI) / 180;  // of an arc, between two points
  const least = 0.01, most = 1.2;  // rad between chord and direction: below a line, above no arc of one stretch

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  /**
   * The points inside the arc from `p` to `q` that ends in `direction` (unit vector), at equal steps: [] for a line.
   * The angle between chord and direction is half of the arc's.
   */
  function inside(p, q, direction) {
    const chord = q.map((v, k) => v - p[k]);
    const length = Math.hypot(...chord);
    if (!(length > 0)) return [];
    const u = chord.map((v) => v / length);
    const along = dot(u, direction);
    const across = direction.map((v, k) => v - along * u[k]);
    const half = Math.atan2(Math.hypot(...across), along);
    if (!(half > least && half < most)) return [];
    const radius = length / (2 * Math.sin(half));
    const v = across.map((c) => c / Math.sin(half));
    const count = Math.ceil((2 * half) / step);
    return Array.from({length: count - 1}, (_, i) => {
      const angle = (2 * half * (i + 1)) / count - half;
      const [x, y] = [radius * (Math.sin(angle) + Math.sin(half)), radius * (Math.cos(half) - Math.cos(angle))];
      return p.map((value, k) => value + x * u[k] + y * v[k]);
    });
  }

  /** A path by stretches as a path by points: see `pathModel.build`. Values on an arc are linear between its ends. */
  function refined({place, rapid, direction, deviation, value}) {
    const points = {place: [], deviation: [], value: [], rapid: [], stretch: []}, last = new Int32Array(value.length);
    const at = (values, i) => Array.from(values.subarray(3 * i, 3 * i + 3));
    const add = (where, off, size, byRapid, stretch) => {
      points.place.push(...where);
      points.deviation.push(...off);
      points.value.push(size);
      points.rapid.push(byRapid);
      points.stretch.push(stretch);
    };
    value.forEach((size, i) => {
      const to = at(deviation, i);
      const arc = i > 0 && !rapid[i] && direction ? inside(at(place, i - 1), at(place, i), at(direction, i)) : [];
      arc.forEach((where, k) => {
        const t = (k + 1) / (arc.length + 1), from = at(deviation, i - 1);
        add(where, from.map((v, c) => v + t * (to[c] - v)), value[i - 1] + t * (size - value[i - 1]), 0, t < 0.5 ? i - 1 : i);
      });
      add(at(place, i), to, size, rapid[i], i);
      last[i] = points.value.length - 1;
    });
    return {count: points.value.length, place: Float32Array.from(points.place), deviation: Float32Array.from(points.deviation),
      value: Float32Array.from(points.value), rapid: Uint8Array.from(points.rapid), stretch: Int32Array.from(points.stretch), last};
  }

  counterflex.arcs = {inside, refined};
})();
