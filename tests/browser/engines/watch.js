// Records the errors of a page, in any engine, and the files that it saves. WebGL fills no triangles, which by software takes
// most of a frame, unless the address ends in `#drawn`.
window.troubles = [];
window.saved = [];
addEventListener('error', ({ message, target }) => {
  troubles.push(message ?? `failed: ${target.src ?? target.href}`);
}, true);
addEventListener('unhandledrejection', ({ reason }) => troubles.push(`rejected: ${reason}`));
document.addEventListener('securitypolicyviolation', ({ blockedURI, effectiveDirective }) => {
  troubles.push(`policy: ${effectiveDirective} ${blockedURI}`);
});
// A page in a sandbox cannot be asked.
if (parent !== window) {
  document.addEventListener('slam-ready', ({ target }) => {
    parent.postMessage({ ready: target.name, hasLap: document.querySelector('#lap.live') !== null, troubles }, '*');
  });
}
{
  const { error } = console;
  console.error = (...parts) => {
    troubles.push(`console: ${parts.join(' ')}`);
    error.apply(console, parts);
  };
  const { createObjectURL } = URL;
  URL.createObjectURL = (blob) => {
    if (!/javascript/.test(blob.type)) saved.push({ type: blob.type, size: blob.size });
    return createObjectURL.call(URL, blob);
  };
  if (location.hash !== '#drawn' && typeof WebGL2RenderingContext === 'function') WebGL2RenderingContext.prototype.drawElements = () => {};
}
