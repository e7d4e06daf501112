// Stands in for Node's fs and path, which Draco's wrapper names but never calls in a browser (vite.config.ts).
export default {};
