// The accepted licences, and the evaluation of SPDX expressions.

import parse from 'spdx-expression-parse';

/**
 * Accepted licences for the module and the page, by preference, each with a pattern that matches its text in lower case
 * with single spaces.
 */
export const SHIPPED = new Map([
  ['MIT', /permission is hereby granted, free of charge, to any person obtaining a copy of this software.*this permission notice.{0,40} shall be included/],
  ['Apache-2.0', /apache license version 2\.0.*terms and conditions for use, reproduction, and distribution/],
  ['Zlib', /provided 'as-is', without any express or implied warranty.*must not be misrepresented/],
  ['ISC', /permission to use, copy, modify,? and(\/or)? distribute this software/],
  ['BSD-2-Clause', /redistributions in binary form must reproduce/],
  ['BSD-3-Clause', /redistributions in binary form must reproduce.*neither the name/],
  ['bzip2-1.0.6', /the origin of this software must not be misrepresented.*julian seward/],
  ['Unicode-3.0', /unicode license v3/],
  ['OFL-1.1', /sil open font license version 1\.1/],
  ['Bitstream-Vera', /bitstream vera fonts copyright/],
]);

/** Accepted licences for build and test, which are not distributed. */
export const TOOLS = [
  ...SHIPPED.keys(),
  'Apache-2.0 WITH LLVM-exception',
  'BSL-1.0',
  'CC-BY-3.0',
  'CC0-1.0',
  'MPL-2.0',
  'NCSA',
  'Ubuntu-font-1.0',
];

/** A question that a person has to decide; the message is one sentence. */
export class LicenceProblem extends Error {}

/** Ends a script with the message of a LicenceProblem, without a stack trace. */
export function endWithOneSentence(error) {
  if (!(error instanceof LicenceProblem)) throw error;
  console.error(error.message);
  process.exit(1);
}

/**
 * Returns the alternatives of an SPDX `expression` that have only accepted licences, by preference. Each is the list of
 * licences that apply together. `what` names the package in a LicenceProblem.
 */
export function acceptedChoices(expression, allowed, what) {
  if (typeof expression !== 'string' || expression.trim() === '') {
    throw new LicenceProblem(`${what} names no licence: read its sources, and do without it if they name none.`);
  }
  const ranks = [...allowed];
  const choices = alternatives(parsed(expression, what)).filter((ids) => ids.every((id) => ranks.includes(id)));
  if (choices.length === 0) {
    throw new LicenceProblem(
      `${what} is under ${expression}, which web/licences/allowed.mjs does not accept: `
      + 'do without it, or add its licence there once somebody has read it.',
    );
  }
  const rank = (ids) => Math.max(...ids.map((id) => ranks.indexOf(id)));
  return choices.sort((a, b) => rank(a) - rank(b));
}

function parsed(expression, what) {
  try {
    // Old crates separate alternatives by a slash.
    return parse(expression.replaceAll('/', ' OR '));
  } catch {
    throw new LicenceProblem(`${what} is under \`${expression}\`, which is no expression of SPDX: ask its authors what it means.`);
  }
}

/** Expands the expression to a list of alternatives; each is a list of licences that apply together. */
function alternatives(tree) {
  if (tree.conjunction === 'or') return [...alternatives(tree.left), ...alternatives(tree.right)];
  if (tree.conjunction === 'and') {
    const right = alternatives(tree.right);
    return alternatives(tree.left).flatMap((one) => right.map((other) => [...new Set([...one, ...other])]));
  }
  const id = tree.plus ? `${tree.license}+` : tree.license;
  return [[tree.exception === undefined ? id : `${id} WITH ${tree.exception}`]];
}
