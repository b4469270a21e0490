// A reporter for node's test runner that writes one JSON object for each test, for run.mjs.

export default async function* events(source) {
  for await (const { type, data } of source) {
    if (type !== 'test:pass' && type !== 'test:fail') continue;
    // A group is counted by its tests; node's own name for a file is not one of our groups.
    if (data.details?.type === 'suite') continue;
    yield `${JSON.stringify({
      name: data.name,
      passed: type === 'test:pass',
      skipped: data.skip ?? false,
      ms: data.details?.duration_ms ?? 0,
    })}\n`;
  }
}
