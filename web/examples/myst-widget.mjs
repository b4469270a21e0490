// MyST copies this file alone into its own build. So it names the module by the site's whole address.

export { default } from 'http://localhost:8016/slam-anywidget.js';
