// node web/licences/check.mjs: fails with one sentence if a dependency has a licence that is not accepted, or
// if the text of a licence is missing.

import { TOOLS, LicenceProblem, endWithOneSentence, waysToTake } from './allowed.mjs';
import { partsOfPage, partsOfWidgets } from './notices.mjs';
import { cratesOf, npmPackagesOf, workspaces } from './packages.mjs';
import { idleTexts } from './texts.mjs';

async function check() {
  const crates = workspaces().flatMap((manifest) => cratesOf(manifest));
  const npm = (await Promise.all(['web', 'tests/browser'].map(npmPackagesOf))).flat();
  for (const { name, version, licence } of [...crates, ...npm]) waysToTake(licence, TOOLS, `${name} ${version}`);

  const parts = [...(await partsOfWidgets([])), ...(await partsOfPage([]))];
  const shipped = parts.flatMap(({ packages }) => packages);
  const [idle] = idleTexts(shipped);
  if (idle !== undefined) {
    throw new LicenceProblem(`web/licences/texts/${idle} serves no package any more: remove it, and its entry in web/licences/texts.mjs.`);
  }
  console.log(`${crates.length} crates and ${npm.length} npm packages have licences that we accept; `
    + `${shipped.length} of them are published with their texts`);
}

await check().catch(endWithOneSentence);
