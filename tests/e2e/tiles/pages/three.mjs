// A tileset as somebody would open it in three.js, and what became of it: window.view.
import * as THREE from 'three';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/three/plugins';
import { ImplicitTilingPlugin } from '3d-tiles-renderer/core/plugins';
import { TilesRenderer } from '3d-tiles-renderer/three';

const query = new URLSearchParams(location.search);
const [east, north, up] = query.get('eye').split(',').map(Number); // in the tileset's frame
const heading = Number(query.get('heading'));
const pitch = Number(query.get('pitch'));

const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color('#ff00ff');
scene.add(new THREE.HemisphereLight(0xffffff, 0x888888, 2));
const sun = new THREE.DirectionalLight(0xffffff, 2);
sun.position.set(1, 1, 0.5);
scene.add(sun);
const camera = new THREE.PerspectiveCamera(60, innerWidth / innerHeight, 1, 200_000);
camera.position.set(east, up, -north);
camera.rotation.set(pitch, -heading, 0, 'YXZ');

const faults = [];
const tiles = new TilesRenderer(query.get('tileset'));
const draco = new DRACOLoader().setDecoderPath('/modules/three/examples/jsm/libs/draco/gltf/');
tiles.registerPlugin(new ImplicitTilingPlugin());
tiles.registerPlugin(new GLTFExtensionsPlugin({ dracoLoader: draco }));
tiles.errorTarget = Number(query.get('error'));
tiles.group.rotation.x = -Math.PI / 2; // z up to y up
tiles.addEventListener('load-error', ({ url, error }) => faults.push(`tile: ${url} ${error}`));
tiles.setCamera(camera);
tiles.setResolutionFromRenderer(camera, renderer);
scene.add(tiles.group);
let quietFrames = 0;
let frames = 0;
renderer.setAnimationLoop(() => {
  camera.updateMatrixWorld();
  tiles.update();
  renderer.render(scene, camera);
  const { downloading, parsing, queued } = tiles.stats;
  const isBusy = downloading + parsing + queued > 0 || tiles.visibleTiles.size === 0;
  quietFrames = isBusy ? 0 : quietFrames + 1;
  frames += 1;
});

window.view = () => ({
  complete: quietFrames > 3,
  shown: tiles.visibleTiles.size,
  loaded: tiles.stats.loaded,
  triangles: renderer.info.render.triangles,
  commands: renderer.info.render.calls,
  frames,
  faults,
});
