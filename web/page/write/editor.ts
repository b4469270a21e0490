// The editor: CodeMirror with line numbers, undo, and marks at the line of an error. Tab leaves it, as anywhere on the page.

import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { javascript } from '@codemirror/lang-javascript';
import { bracketMatching, defaultHighlightStyle, indentOnInput, syntaxHighlighting } from '@codemirror/language';
import { setDiagnostics } from '@codemirror/lint';
import { EditorState } from '@codemirror/state';
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from '@codemirror/view';

const LOOK = EditorView.theme({
  '&': { border: '1px solid currentColor', borderRadius: '6px', fontSize: '0.9rem', background: '#fff', color: '#111' },
  '.cm-scroller': { fontFamily: 'ui-monospace, monospace', maxHeight: '24rem', overflow: 'auto' },
  '.cm-gutters': { background: '#f4f4f4', color: '#555' },
});

export interface Editor {
  text(): string;
  /** Replaces the text; undo brings it back. */
  replace(text: string): void;
  /** Marks a line with a message; without one removes the marks. */
  mark(line?: number, message?: string): void;
}

/** Puts an editor into a place. */
export function edit(place: HTMLElement, text: string, label: string, changed: (text: string) => void): Editor {
  const view = new EditorView({
    parent: place,
    state: EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), history(), drawSelection(), indentOnInput(), EditorView.lineWrapping, bracketMatching(), highlightActiveLine(),
        syntaxHighlighting(defaultHighlightStyle), javascript(), keymap.of([...defaultKeymap, ...historyKeymap]), LOOK,
        EditorView.contentAttributes.of({ 'aria-label': label, spellcheck: 'false', autocapitalize: 'off' }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) changed(update.state.doc.toString());
        }),
      ],
    }),
  });
  return {
    text: () => view.state.doc.toString(),
    replace: (next) => view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: next } }),
    mark: (line, message = '') => {
      const at = line === undefined || line > view.state.doc.lines ? undefined : view.state.doc.line(line);
      const marks = at === undefined ? [] : [{ from: at.from, to: at.to, severity: 'error' as const, message }];
      view.dispatch(setDiagnostics(view.state, marks));
    },
  };
}
