// A reporter of node's test runner that writes what run.mjs needs: one JSON object for each test.

export default async function* events(source) {
  for await (const { type, data } of source) {
    if (type !== 'test:pass' && type !== 'test:fail') continue;
    // A group counts as its tests; node's own name for a file is no group of ours.
    if (data.details?.type === 'suite') continue;
    yield `${JSON.stringify({
      name: data.name,
      passed: type === 'test:pass',
      skipped: data.skip ?? false,
      ms: data.details?.duration_ms ?? 0,
    })}\n`;
  }
}
