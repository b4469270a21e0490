// Talks to the widget in the frame by messages; docs/embedding.md lists them.

const frame = document.querySelector('#lap');

addEventListener('message', (event) => {
  if (event.source !== frame.contentWindow || event.data?.slam !== 1) return;
  if (event.data.type === 'size' || event.data.type === 'state') frame.style.height = `${event.data.height}px`;
  if (event.data.type === 'result') {
    document.querySelector('#said').textContent = event.data.outcome.sentence;
  }
});

document.querySelector('#noisy').addEventListener('click', () => {
  frame.contentWindow.postMessage({ slam: 1, type: 'set', values: { noise: 2 } }, '*');
});

// A frame that loaded before this script has already sent its size, which is in its state, too.
frame.contentWindow.postMessage({ slam: 1, type: 'get' }, '*');
