// The state of a widget in a link: `?w=16.2&noise=2&seed=7`.

import { allParamIds, findParam, findWidget, type WidgetSpec } from './schema';
import { defaultText, parseValue } from './values';

export interface LinkedState {
  /** The widget: `w16.2`. */
  widget: WidgetSpec;
  /** Its parameters as valid texts. */
  values: [string, string][];
  /** A sentence for each error. */
  problems: string[];
}

/** Parses a query; undefined if it has no `w`. */
export function readQuery(query: string): LinkedState | { problems: string[] } | undefined {
  const params = new URLSearchParams(query);
  const name = params.get('w');
  if (name === null) return undefined;
  const widget = findWidget(name.startsWith('w') ? name : `w${name}`);
  if (widget === undefined) return { problems: [`There is no widget \`${name.slice(0, 60)}\`.`] };
  const values: [string, string][] = [];
  const problems: string[] = [];
  for (const [id, text] of params) {
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

/** Replaces the state in the query of a page. Parameters that belong to no widget are kept. */
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
