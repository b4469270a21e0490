// The state of a widget in a link: `?w=16.2&noise=2&seed=7`.

import { allParamIds, findParam, findWidget, type WidgetSpec } from './schema';
import { defaultText, parseValue } from './values';

export interface LinkedState {
  /** The widget: `w16.2`. */
  widget: WidgetSpec;
  /** Its parameters as checked texts. */
  values: [string, string][];
  /** The errors, a sentence each. */
  problems: string[];
}

/** Reads a query; undefined if it names no widget. */
export function readQuery(query: string): LinkedState | { problems: string[] } | undefined {
  const asked = new URLSearchParams(query);
  const name = asked.get('w');
  if (name === null) return undefined;
  const widget = findWidget(name.startsWith('w') ? name : `w${name}`);
  if (widget === undefined) return { problems: [`There is no widget \`${name.slice(0, 60)}\`.`] };
  const values: [string, string][] = [];
  const problems: string[] = [];
  for (const [id, text] of asked) {
    if (id === 'w' || id === 'theme') continue;
    const spec = findParam(widget, id);
    if (spec === undefined) {
      const known = widget.params.map((param) => param.id).join(', ');
      problems.push(`${widget.id} has no parameter \`${id.slice(0, 60)}\`; it has ${known}.`);
      continue;
    }
    const parsed = parseValue(spec, text);
    if (parsed.ok) values.push([id, parsed.text]);
    else problems.push(`${parsed.problem}. The default is used.`);
  }
  return { widget, values, problems };
}

/** The query of a page one of whose widgets is in that state; what no widget knows belongs to the page and stays. */
export function withState(search: string, state: string): string {
  const query = new URLSearchParams(search);
  for (const id of ['w', ...allParamIds()]) query.delete(id);
  for (const [id, text] of new URLSearchParams(state)) query.set(id, text);
  return `?${query.toString()}`;
}

/** Writes a query with every parameter that is not at its default. */
export function writeQuery(widget: WidgetSpec, values: ReadonlyMap<string, string>): string {
  const query = new URLSearchParams({ w: widget.id.replace(/^w/, '') });
  for (const spec of widget.params) {
    const text = values.get(spec.id);
    if (text !== undefined && text !== defaultText(spec)) query.set(spec.id, text);
  }
  return `?${query.toString()}`;
}
