// node web/scorm.mjs DIST FILE: a SCORM 1.2 package of the exercises, one shareable content object for each.
//
// Each object is embed.html with the exercise in its address; web/ts/scorm.ts reports the answers.

import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { escapeHtml } from './html.mjs';
import { writeZip } from './zip.mjs';

/** Files that embed.html loads, and the licences. */
const FILES = /^(embed\.html|exercises\.json|slam-[\w-]+\.js|slam_web-\w+\.wasm|pictures\/.*|LICENSE-.*|THIRD-PARTY-NOTICES\.txt)$/;

const [dist, target] = process.argv.slice(2);
if (dist === undefined || target === undefined) throw new Error('usage: node web/scorm.mjs DIST FILE');

const files = (await readdir(dist, { recursive: true })).map((name) => name.replaceAll('\\', '/')).filter((name) => FILES.test(name)).sort();
const exercises = JSON.parse(await readFile(join(dist, 'exercises.json'), 'utf8'));
const contents = { 'imsmanifest.xml': new TextEncoder().encode(manifest()) };
for (const name of files) contents[name] = new Uint8Array(await readFile(join(dist, name)));
console.log(`${target}: ${exercises.length} exercises, ${await writeZip(target, contents)} bytes`);

/** SCORM 1.2 Content Aggregation Model, section 2.3. */
function manifest() {
  const items = exercises.map(({ title, name }) => `
      <item identifier="item-${name}" identifierref="exercise-${name}"><title>${escapeHtml(title.replaceAll('&amp;', '&'))}</title></item>`);
  const resources = exercises.map(({ name }) => `
    <resource identifier="exercise-${name}" type="webcontent" adlcp:scormtype="sco" href="embed.html?exercise=${name}">
      <file href="embed.html"/>
      <dependency identifierref="program"/>
    </resource>`);
  const program = files.filter((name) => name !== 'embed.html').map((name) => `
      <file href="${escapeHtml(name)}"/>`);
  return `<?xml version="1.0" encoding="UTF-8"?>
<manifest identifier="slam2d-exercises" version="1.0"
  xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2" xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2">
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
