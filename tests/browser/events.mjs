// A reporter for node's test runner that writes one JSON object for each test, for run.mjs.

export default async function* events(source) {
  for await (const { type, data } of source) {
    if (type !== 'test:pass' && type !== 'test:fail') continue;
    // Node reports a group as a test of its own.
    if (data.details?.type === 'suite') continue;
    yield `${JSON.stringify({
      name: data.name,
      nesting: data.nesting,
      passed: type === 'test:pass',
      skipped: data.skip ?? false,
      ms: data.details?.duration_ms ?? 0,
    })}\n`;
  }
}
