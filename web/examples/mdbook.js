// Stands in for mdBook, whose arrow keys turn the page, whatever has the focus. Here they change the address.

const turns = { ArrowLeft: '#previous', ArrowRight: '#next' };

document.addEventListener('keydown', (event) => {
  if (event.altKey || event.ctrlKey || event.metaKey) return;
  if (event.key in turns) location.hash = turns[event.key];
});
