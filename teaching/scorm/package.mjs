// node teaching/scorm/package.mjs DIST FILE [first|best|last]: a SCORM 1.2 package of the exercises, one shareable content object for each;
// the last argument says which of several answers to a question counts.
//
// Each object is embed.html with the exercise in its address; web/ts/scorm.ts reports the answers.

import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { escapeHtml } from '../../web/html.mjs';
import { writeZip } from '../../web/zip.mjs';

/** Files that embed.html loads, and the licences. */
const FILES = /^(embed\.html|exercises\.json|slam-[\w-]+\.js|slam_web-\w+\.wasm|pictures\/.*|LICENSE-.*|THIRD-PARTY-NOTICES\.txt)$/;

const SCHEMAS = fileURLToPath(new URL('schemas', import.meta.url));

const [dist, target, counts = 'first'] = process.argv.slice(2);
if (dist === undefined || target === undefined || !['first', 'best', 'last'].includes(counts)) {
  throw new Error('usage: node teaching/scorm/package.mjs DIST FILE [first|best|last]');
}

const files = (await readdir(dist, { recursive: true })).map((name) => name.replaceAll('\\', '/')).filter((name) => FILES.test(name)).sort();
const exercises = JSON.parse(await readFile(join(dist, 'exercises.json'), 'utf8'));
const contents = { 'imsmanifest.xml': new TextEncoder().encode(manifest()) };
for (const name of files) contents[name] = new Uint8Array(await readFile(join(dist, name)));
// Systems that validate a package look for the schemas beside the manifest.
for (const name of await readdir(SCHEMAS)) contents[name] = new Uint8Array(await readFile(join(SCHEMAS, name)));
console.log(`${target}: ${exercises.length} exercises, ${await writeZip(target, contents)} bytes`);

/** SCORM 1.2 Content Aggregation Model, section 2.3. */
function manifest() {
  const items = exercises.map(({ title, name }) => `
      <item identifier="item-${name}" identifierref="exercise-${name}"><title>${escapeHtml(title.replaceAll('&amp;', '&'))}</title></item>`);
  const resources = exercises.map(({ name }) => `
    <resource identifier="exercise-${name}" type="webcontent" adlcp:scormtype="sco" href="embed.html?exercise=${name}&amp;counts=${counts}">
      <file href="embed.html"/>
      <dependency identifierref="program"/>
    </resource>`);
  const program = files.filter((name) => name !== 'embed.html').map((name) => `
      <file href="${escapeHtml(name)}"/>`);
  return `<?xml version="1.0" encoding="UTF-8"?>
<manifest identifier="slam2d-exercises" version="1.0"
  xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2" xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
  xsi:schemaLocation="http://www.imsproject.org/xsd/imscp_rootv1p1p2 imscp_rootv1p1p2.xsd
    http://www.adlnet.org/xsd/adlcp_rootv1p2 adlcp_rootv1p2.xsd">
  <metadata><schema>ADL SCORM</schema><schemaversion>1.2</schemaversion></metadata>
  <organizations default="chapter">
    <organization identifier="chapter">
      <title>SLAM in two dimensions: exercises</title>${items.join('')}
    </organization>
  </organizations>
  <resources>${resources.join('')}
    <resource identifier="program" type="webcontent" adlcp:scormtype="asset">${program.join('')}
    </resource>
  </resources>
</manifest>
`;
}
