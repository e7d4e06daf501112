import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

// The Draco wrapper asks for these only when it runs under Node, which it never does here.
const nothing = fileURLToPath(new URL('./src/world/no_node_module.ts', import.meta.url));

export default defineConfig({
  base: './',
  resolve: { alias: { fs: nothing, path: nothing } },
  build: { target: 'es2022', chunkSizeWarningLimit: 900, assetsInlineLimit: 0 },
  worker: { format: 'es' },
  test: { include: ['tests/**/*.test.ts'] },
});
