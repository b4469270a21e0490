// MyST copies only this file into its build, so the module has an absolute address.

export { default } from 'http://localhost:8016/slam-anywidget.js';
