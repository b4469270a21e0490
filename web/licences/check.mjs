// node web/licences/check.mjs: fails with one sentence if a licence of a dependency is not accepted, or its text is missing.

import { TOOLS, LicenceProblem, endWithOneSentence, acceptedChoices } from './allowed.mjs';
import { partsOfPage, partsOfWidgets } from './notices.mjs';
import { cratesOf, npmPackagesOf, workspaces } from './packages.mjs';
import { unusedTexts } from './texts.mjs';

async function check() {
  const crates = workspaces().flatMap((manifest) => cratesOf(manifest));
  const npm = (await Promise.all(['web', 'tests/browser'].map(npmPackagesOf))).flat();
  for (const { name, version, licence } of [...crates, ...npm]) acceptedChoices(licence, TOOLS, `${name} ${version}`);

  const parts = [...(await partsOfWidgets([])), ...(await partsOfPage([]))];
  const shipped = parts.flatMap(({ packages }) => packages);
  const [unused] = unusedTexts(shipped);
  if (unused !== undefined) {
    throw new LicenceProblem(`no package uses web/licences/texts/${unused} any more: remove it, and its entry in web/licences/texts.mjs.`);
  }
  console.log(`${crates.length} crates and ${npm.length} npm packages have licences that we accept; `
    + `${shipped.length} of them are published with their texts`);
}

await check().catch(endWithOneSentence);
