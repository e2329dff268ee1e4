'use strict';
/**
 * Draws paths with WebGL (three.js): ribbons of constant width on the screen, coloured by deviation. The shader adds
 * the deviation, so that a change of exaggeration is fast.
 */
(() => {
  const vertexShader = `
    attribute vec3 end, deviation, end_deviation;
    attribute vec2 fraction, corner;
    uniform float exaggeration, width, lift;
    uniform vec2 half_size;
    varying vec2 at, fractions;
    varying float segment;

    vec3 on_screen(vec3 place) {
      vec4 p = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
      return vec3(p.xy * half_size, p.z);
    }

    void main() {
      vec3 a = on_screen(position + exaggeration * deviation);
      vec3 b = on_screen(end + exaggeration * end_deviation);
      vec2 line = b.xy - a.xy;
      segment = length(line);
      vec2 along = segment > 1e-4 ? line / segment : vec2(1.0, 0.0);
      float cap = 0.5 * width * (2.0 * corner.x - 1.0);
      at = vec2(corner.x * segment + cap, 0.5 * width * corner.y);
      fractions = fraction;
      vec3 p = mix(a, b, corner.x);
      vec2 offset = along * cap + vec2(-along.y, along.x) * at.y;
      gl_Position = vec4((p.xy + offset) / half_size, p.z - lift, 1.0);
    }`;

  const fragmentShader = `
    uniform sampler2D scale;
    uniform vec3 colour;
    uniform float width, opacity, dash, coloured;
    varying vec2 at, fractions;
    varying float segment;

    void main() {
      float x = clamp(at.x, 0.0, segment);
      if (length(vec2(at.x - x, at.y)) > 0.5 * width) discard;
      if (dash > 0.0 && mod(at.x, dash) > 0.55 * dash) discard;
      float f = mix(fractions.x, fractions.y, x / max(segment, 1e-4));
      bool known = coloured > 0.5 && fractions.x >= 0.0 && fractions.y >= 0.0;
      vec3 shade = known ? texture2D(scale, vec2((f * 255.0 + 0.5) / 256.0, 0.5)).rgb : colour;
      gl_FragColor = vec4(shade, opacity);
    }`;

  const corners = [[0, -1], [1, -1], [1, 1], [0, 1]];

  /** The segments [from, to] of a layer: feeds or rapids; for a path with one place, that place. */
  function segments(path, rapid) {
    const list = [];
    for (let i = 1; i < path.count; ++i)
      if (Boolean(path.rapid[i]) === rapid) list.push([i - 1, i]);
    if (path.count === 1 && !rapid) list.push([0, 0]);
    return list;
  }

  /** A vertex attribute, `width` values for each of four corners; `value(segment, corner, k)`. */
  function attribute(list, width, value) {
    const array = new Float32Array(list.length * 4 * width);
    list.forEach((segment, i) => corners.forEach((corner, c) => {
      for (let k = 0; k < width; ++k) array[(4 * i + c) * width + k] = value(segment, corner, k);
    }));
    return new THREE.BufferAttribute(array, width);
  }

  function geometryOf(path, rapid) {
    const list = segments(path, rapid);
    const geometry = new THREE.BufferGeometry();
    const of = (values, end, width) => attribute(list, width, (segment, _, k) => values[width * segment[end] + k]);
    geometry.setAttribute('position', of(path.place, 0, 3));
    geometry.setAttribute('end', of(path.place, 1, 3));
    geometry.setAttribute('deviation', of(path.deviation, 0, 3));
    geometry.setAttribute('end_deviation', of(path.deviation, 1, 3));
    geometry.setAttribute('fraction', attribute(list, 2, (segment, _, k) => path.fraction[segment[k]]));
    geometry.setAttribute('corner', attribute(list, 2, (_, corner, k) => corner[k]));
    const index = new Uint32Array(list.length * 6);
    list.forEach((_, i) => index.set([0, 1, 2, 0, 2, 3].map((c) => 4 * i + c), 6 * i));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  function scaleTexture(dark) {
    const bytes = counterflex.colours.table(256, dark);
    const texture = new THREE.DataTexture(bytes, 256, 1, THREE.RGBAFormat);
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
  }

  const uniformNames = ['exaggeration', 'width', 'lift', 'half_size', 'scale', 'colour', 'opacity', 'dash',
    'coloured'];

  function meshOf(layer) {
    const material = new THREE.ShaderMaterial({vertexShader: vertexShader, fragmentShader: fragmentShader,
      uniforms: Object.fromEntries(uniformNames.map((name) => [name, {value: 0}])), side: THREE.DoubleSide,
      transparent: true, depthWrite: layer.covers, depthTest: layer.covers});
    const mesh = new THREE.Mesh(geometryOf(layer.path, layer.style === 'rapid'), material);
    mesh.frustumCulled = false;
    return mesh;
  }

  /**
   * The values of a layer for this picture; `place`: its number from the bottom, later layers cover earlier ones at
   * equal depth.
   */
  function setUniforms(mesh, layer, place, picture, size, scale) {
    const values = {exaggeration: layer.factor, width: layer.width * size.ratio, lift: 2e-4 * place,
      half_size: new THREE.Vector2(0.5 * size.width * size.ratio, 0.5 * size.height * size.ratio), scale,
      colour: new THREE.Vector3(...(layer.style === 'deviation' ? picture.theme.muted : layer.colour)),
      opacity: layer.opacity, dash: layer.dash.reduce((sum, v) => sum + v, 0) * size.ratio,
      coloured: layer.style === 'deviation' ? 1 : 0};
    for (const name of uniformNames) mesh.material.uniforms[name].value = values[name];
    mesh.renderOrder = place;
  }

  /** `reach`: radius in mm around the middle of the picture that includes everything. */
  function setCamera(eye, camera, size, reach) {
    const {right, up, back} = counterflex.camera.basis(camera);
    const half = 0.5 / counterflex.camera.scale(camera, size);
    [eye.left, eye.right, eye.bottom, eye.top] =
      [-half * size.width, half * size.width, -half * size.height, half * size.height];
    [eye.near, eye.far] = [0, 2 * reach];
    eye.updateProjectionMatrix();
    const axes = [right, up, back].map((v) => new THREE.Vector3(...v));
    eye.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(...axes));
    eye.position.set(...camera.centre.map((v, i) => v + reach * back[i]));
  }

  /** Keeps a mesh for each layer of the last picture; builds a new one for another path. */
  function updateMeshes(scene, meshes, layers) {
    layers.forEach((layer, i) => {
      if (meshes[i] && meshes[i].path === layer.path && meshes[i].style === layer.style) return;
      if (meshes[i]) remove(scene, meshes[i]);
      meshes[i] = {mesh: meshOf(layer), path: layer.path, style: layer.style};
      scene.add(meshes[i].mesh);
    });
    for (const extra of meshes.splice(layers.length)) remove(scene, extra);
  }

  function remove(scene, {mesh}) {
    scene.remove(mesh);
    mesh.geometry.dispose();
    mesh.material.dispose();
  }

  /**
   * The view, or null without WebGL. It draws on its own canvas and copies that to the given one, which thus always has
   * a complete picture. Calls `lost()` when the graphics processor is lost.
   */
  function create(lost) {
    const renderer = makeRenderer();
    if (!renderer) return null;
    renderer.domElement.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      lost();
    });
    const scene = new THREE.Scene();
    const eye = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    const meshes = [];
    const scales = {true: scaleTexture(true), false: scaleTexture(false)};
    return {name: 'webgl', dispose: () => renderer.dispose(), draw(context, size, picture) {
      renderer.setPixelRatio(size.ratio);
      renderer.setSize(size.width, size.height, false);
      renderer.setClearColor(new THREE.Color(...picture.theme.ground), 1);
      updateMeshes(scene, meshes, picture.layers);
      picture.layers.forEach((layer, i) =>
        setUniforms(meshes[i].mesh, layer, i, picture, size, scales[picture.theme.dark]));
      setCamera(eye, picture.camera, size, picture.reach);
      renderer.render(scene, eye);
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.drawImage(renderer.domElement, 0, 0);
      context.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
    }};
  }

  /** The context, or null without WebGL. Tested before three.js is used, which would print errors. */
  function makeRenderer() {
    if (typeof THREE === 'undefined') return null;
    const canvas = document.createElement('canvas');
    const wanted = {alpha: false, antialias: true, failIfMajorPerformanceCaveat: false};
    try {
      const context = canvas.getContext('webgl', wanted);
      return context ? new THREE.WebGLRenderer({canvas, context}) : null;
    } catch (error) {
      return null;
    }
  }

  counterflex.ribbonView = {create};
})();
