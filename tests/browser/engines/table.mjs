// The table of engine × page × action: what passed in the last run of the engines' tests.

/** Name of an engine's file of tests, and of the engine in the table. */
export const ENGINES = { 'engine-chromium': 'Chromium', 'engine-firefox': 'Firefox', 'engine-webkit': 'WebKit' };

/** The table in Markdown, from the results of each file; a test with parts has a row that lists them. */
export function engineTable(files) {
  const rows = new Map();
  const engines = Object.entries(ENGINES).filter(([file]) => files.some(({ name }) => name === file));
  for (const [file, engine] of engines) {
    let parts = [];
    for (const { name, nesting, passed, skipped } of files.find((one) => one.name === file).tests) {
      const mark = skipped !== false ? '–' : passed ? '✓' : '✗';
      if (nesting > 1) {
        parts.push({ name, mark });
        continue;
      }
      const row = rows.get(name) ?? { parts: [], marks: {} };
      const wrong = parts.filter((part) => part.mark === '✗').map((part) => part.name);
      if (parts.length > row.parts.length) row.parts = parts.map((part) => part.name);
      row.marks[engine] = wrong.length === 0 ? mark : `✗ ${wrong.join(', ')}`;
      rows.set(name, row);
      parts = [];
    }
  }
  const line = (cells) => `| ${cells.join(' | ')} |`;
  const names = engines.map(([, engine]) => engine);
  return [
    line(['what a reader does', ...names]),
    line(['---', ...names.map(() => ':-:')]),
    ...[...rows].map(([name, { parts, marks }]) => line([
      parts.length === 0 ? name : `${name}: ${parts.join(', ')}`, ...names.map((engine) => marks[engine] ?? ''),
    ])),
  ].join('\n');
}
