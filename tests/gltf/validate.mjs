// validate.mjs FILE...: the Khronos glTF validator. Prints every error and warning; exit status 1
// when there is any. Packages come from the folder in PRTKIT_NODE_MODULES.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const modules = process.env.PRTKIT_NODE_MODULES ?? join(process.cwd(), 'node_modules');
const { validateBytes } = createRequire(join(modules, 'anchor.js'))('gltf-validator');

const files = process.argv.slice(2);
if (files.length === 0) throw new Error('usage: validate.mjs FILE...');
for (const file of files) {
  const report = await validateBytes(new Uint8Array(readFileSync(file)), { uri: file });
  const { numErrors, numWarnings, messages } = report.issues;
  for (const { severity, pointer, message } of messages) {
    if (severity < 2) console.log(`${file}: ${pointer ?? ''}: ${message}`);
  }
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
  if (numErrors + numWarnings > 0) process.exitCode = 1;
}
