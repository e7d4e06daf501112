// The join token of the page's own URL (?token=), for servers that let only some in; `talus token` makes one.

export function tokenOf(query: string): string {
  return new URLSearchParams(query).get('token') ?? '';
}

/// What a request says to prove it: nothing without a token, so that anonymous requests stay simple ones.
export function authorization(token: string): Record<string, string> {
  return token === '' ? {} : { Authorization: `Bearer ${token}` };
}

/// Of this page; empty outside a page.
export const pageToken = tokenOf(typeof location === 'undefined' ? '' : location.search);
