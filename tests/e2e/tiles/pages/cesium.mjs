// A tileset as somebody would open it in CesiumJS, and what became of it: window.view.
/* global Cesium */
const query = new URLSearchParams(location.search);
const eye = query.get('eye').split(',').map(Number); // in the tileset's frame: east, north, up
const heading = Number(query.get('heading'));
const pitch = Number(query.get('pitch'));

const widget = new Cesium.CesiumWidget('view', {
  baseLayer: false,
  globe: false,
  skyBox: false,
  skyAtmosphere: false,
  scene3DOnly: true,
  msaaSamples: 1,
  orderIndependentTranslucency: false,
  creditContainer: document.createElement('div'),
  contextOptions: { webgl: { preserveDrawingBuffer: true } },
});
widget.scene.backgroundColor = Cesium.Color.fromCssColorString('#ff00ff');
const faults = [];
widget.scene.renderError.addEventListener((_, error) => faults.push(`render: ${error}`));
let frames = 0;
widget.scene.postRender.addEventListener(() => (frames += 1));

const tileset = await Cesium.Cesium3DTileset.fromUrl(query.get('tileset'), { maximumScreenSpaceError: Number(query.get('error')) });
tileset.tileFailed.addEventListener(({ url, message }) => faults.push(`tile: ${url} ${message}`));
widget.scene.primitives.add(tileset);
const toGlobe = tileset.root.computedTransform;
widget.camera.setView({ destination: Cesium.Matrix4.multiplyByPoint(toGlobe, new Cesium.Cartesian3(...eye), new Cesium.Cartesian3()) });
// The same light at any hour: from the south-west, from above.
const light = Cesium.Matrix4.multiplyByPointAsVector(toGlobe, new Cesium.Cartesian3(0.5, 0.4, -0.77), new Cesium.Cartesian3());
widget.scene.light = new Cesium.DirectionalLight({ direction: light });
const direction = new Cesium.Cartesian3(
  Math.sin(heading) * Math.cos(pitch),
  Math.cos(heading) * Math.cos(pitch),
  Math.sin(pitch),
);
const up = new Cesium.Cartesian3(-Math.sin(heading) * Math.sin(pitch), -Math.cos(heading) * Math.sin(pitch), Math.cos(pitch));
widget.camera.direction = Cesium.Matrix4.multiplyByPointAsVector(toGlobe, direction, new Cesium.Cartesian3());
widget.camera.up = Cesium.Matrix4.multiplyByPointAsVector(toGlobe, up, new Cesium.Cartesian3());
widget.camera.right = Cesium.Cartesian3.cross(widget.camera.direction, widget.camera.up, new Cesium.Cartesian3());

window.view = () => ({
  complete: tileset.tilesLoaded && tileset.statistics.selected > 0,
  shown: tileset.statistics.selected,
  loaded: tileset.statistics.numberOfTilesWithContentReady,
  pending: tileset.statistics.numberOfPendingRequests,
  processing: tileset.statistics.numberOfTilesProcessing,
  triangles: tileset.statistics.numberOfTrianglesSelected,
  commands: tileset.statistics.numberOfCommands,
  frames,
  faults,
});
