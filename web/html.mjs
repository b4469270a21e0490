/**
 * What a page may load: only what a page with widgets needs, from its own site; fonts are those of the formulas, frames
 * those of the examples and of the reader's code. In a sandbox, without an origin, a worker starts from data.
 */
export const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob: data:; connect-src 'self'; img-src 'self' data:; "
  + "style-src 'self' 'unsafe-inline'; font-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'";
/** The tag that pages opened from the disk have to lose. */
export const POLICY_TAG = /<meta http-equiv="Content-Security-Policy" content="[^"]*">\n/;

/**
 * A page with its policy, as the first thing that it loads. Where a reader connects to a robot, the policy opens WebSockets.
 * A page of the chapter sets it by its first script, `web/ts/restrict.ts`, because in a sandbox it must name the site.
 */
export function withPolicy(html) {
  const policy = / name="w16\.10"[^>]* connects/.test(html) ? POLICY.replace("connect-src 'self'", "connect-src 'self' ws: wss:") : POLICY;
  const first = '<script src="early-';
  if (html.includes(first)) return html.replace(first, `<script data-policy="${policy}" src="early-`);
  const tag = `<meta http-equiv="Content-Security-Policy" content="${policy}">\n`;
  return html.replace('<meta charset="utf-8">\n', (charset) => charset + tag);
}

/** Escapes a text for HTML and XML, including attributes. */
export function escapeHtml(text) {
  return text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;').replaceAll('"', '&quot;');
}
