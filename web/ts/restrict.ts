// The policy of a page that may be in a sandbox.

/**
 * Restricts what this page may load from now on; a page from the disk has no origin that a policy could name. In a sandbox
 * it has none either, and WebKit then matches 'self' with nothing: the policy has to name the site, which only a script knows.
 */
export function restrict(policy: string): void {
  if (location.protocol === 'file:') return;
  const tag = document.createElement('meta');
  tag.httpEquiv = 'Content-Security-Policy';
  tag.content = policy.replaceAll("'self'", `'self' ${location.origin}`);
  document.head.append(tag);
}
