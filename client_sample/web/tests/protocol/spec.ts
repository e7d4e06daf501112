import { readFileSync } from 'node:fs';

/// The bytes of the block of SPEC.md that begins with ```hex NAME.
export function specBytes(name: string): Uint8Array {
  const text = readFileSync(new URL('../../../../protocol/SPEC.md', import.meta.url), 'utf8');
  const words = new RegExp(`\`\`\`hex ${name}\\n([^\`]*)\`\`\``).exec(text)?.[1]?.trim().split(/\s+/) ?? [];
  return Uint8Array.from(words, (word) => parseInt(word, 16));
}
