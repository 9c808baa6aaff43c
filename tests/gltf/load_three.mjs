// load_three.mjs FILE...: loads with three.js's GLTFLoader and prints what it found; exit status 1
// when it fails or finds no mesh. Packages come from the folder in PRTKIT_NODE_MODULES.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

// What the loader expects of a browser. Textures are not decoded: their first bytes must do.
globalThis.self = globalThis;
globalThis.createImageBitmap = async (blob) => {
  const magic = Buffer.from(await blob.arrayBuffer()).toString('latin1', 0, 4);
  if (magic !== '\x89PNG' && !magic.startsWith('\xff\xd8\xff')) throw new Error('bad image');
  return { width: 1, height: 1, close() {} };
};

const modules = process.env.PRTKIT_NODE_MODULES ?? join(process.cwd(), 'node_modules');
const loader_path = join(modules, 'three/examples/jsm/loaders/GLTFLoader.js');
const { GLTFLoader } = await import(pathToFileURL(loader_path).href);

const files = process.argv.slice(2);
if (files.length === 0) throw new Error('usage: load_three.mjs FILE...');
for (const file of files) {
  const bytes = readFileSync(file);
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const gltf = await new GLTFLoader().parseAsync(buffer, '');
  const meshes = [];
  gltf.scene.traverse((object) => object.isMesh && meshes.push(object));
  if (meshes.length === 0) throw new Error(`${file}: no mesh`);
  for (const { name, geometry } of meshes) {
    const { attributes, index } = geometry;
    console.log(`${file}: ${name}: ${attributes.position.count} vertices, ` +
                `${index.count / 3} triangles, ${Object.keys(attributes).sort().join(' ')}`);
  }
}
