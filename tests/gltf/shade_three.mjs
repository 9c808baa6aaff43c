// shade_three.mjs FOLDER: three.js's GLTFLoader reads the diffuse examples of the specification in
// FOLDER, and what it made of their accessors gives the exit radiance of test_vectors.json. Exit
// status 1 when it does not. Packages come from the folder in PRTKIT_NODE_MODULES.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

// What the loader expects of a browser.
globalThis.self = globalThis;
globalThis.ProgressEvent ??= Event;
const modules = process.env.PRTKIT_NODE_MODULES ?? join(process.cwd(), 'node_modules');
const load = (file) => import(pathToFileURL(join(modules, 'three', file)).href);
const { DataUtils } = await load('build/three.module.js');
const { GLTFLoader } = await load('examples/jsm/loaders/GLTFLoader.js');

const kName = 'PRTKIT_precomputed_transfer';
const folder = process.argv[2];
const vectors = JSON.parse(readFileSync(join(folder, 'test_vectors.json')));

// Weights of all vertices, a list each.
async function readWeights(parser, transfer, clusters, counts, primitive, attributes) {
  const isHalf = transfer.weightComponentType === 5131;
  const number = ({ array, normalized }, i) =>
      isHalf ? DataUtils.fromHalfFloat(array[i]) :
      normalized ? array[i] / (2 ** (8 * array.BYTES_PER_ELEMENT) - 1) : array[i];
  if (transfer.componentCounts === undefined) {
    return clusters.map((_, v) => Array.from({ length: transfer.componentCount }, (_, p) =>
        number(attributes[`_prt_weights_${p >> 2}`], 4 * v + (p & 3))));
  }
  const packed = await parser.getDependency('accessor', primitive.extensions[kName].weights);
  let next = 0;
  return clusters.map((k) => Array.from({ length: counts[k] }, () => number(packed, next++)));
}

async function shade({ file, cases }) {
  const { parser, scene } = await new GLTFLoader().parseAsync(
      readFileSync(join(folder, file), 'utf8'), '');
  const transfer = parser.json.extensions[kName].transfers[0];
  const table = async (key) => (await parser.getDependency('accessor', transfer[key])).array;
  const primitive = parser.json.meshes[0].primitives[0];
  const { attributes } = scene.getObjectByProperty('isMesh', true).geometry;
  const cluster = attributes._prt_cluster;
  const clusters = Array.from({ length: cluster.count }, (_, v) => cluster.getX(v));
  const counts = transfer.componentCounts === undefined
      ? Array(transfer.clusterCount).fill(transfer.componentCount)
      : await table('componentCounts');
  const weights =
      await readWeights(parser, transfer, clusters, counts, primitive, attributes);
  const [means, bases] = [await table('means'), await table('bases')];
  const n = transfer.bandCount ** 2, size = transfer.channelCount * n;
  const first = (k) => counts.slice(0, k).reduce((sum, count) => sum + count, 0);
  let worst = 0;
  for (const { light, exitRadiance } of cases) {
    clusters.forEach((k, v) => light.forEach((coefficients, c) => {
      const channel = transfer.channelCount === 3 ? c * n : 0;
      const exit = coefficients.reduce((sum, l, i) => sum + l * weights[v].reduce(
          (x, w, p) => x + w * bases[(first(k) + p) * size + channel + i],
          means[k * size + channel + i]), 0);
      worst = Math.max(worst, Math.abs(exit - exitRadiance[v][c]));
    }));
  }
  console.log(`${file}: ${attributes._prt_weights_0?.array.constructor.name ?? 'packed'}, ` +
              `${clusters.length} vertices, off by at most ${worst.toExponential(1)}`);
  if (!(worst <= 1e-5)) process.exitCode = 1;
}

for (const example of [vectors.fixed, vectors.adaptive, vectors.half]) await shade(example);
