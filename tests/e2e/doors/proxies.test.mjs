// Where a request ends, talusd and the proxies people put in front of it must agree, or one client's bytes become another's
// request. A corpus of requests that servers have read in different ways goes to talusd alone and through nginx and
// HAProxy. Behind each comes a request that says what was made of it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { request, speak } from './frame/http.mjs';
import { answersIn, proxies, startProxy, startTap } from './frame/proxies.mjs';
import { startServer } from './frame/server.mjs';

const host = 'Host: a\r\n';
const last = `GET /v1/last HTTP/1.1\r\n${host}Connection: close\r\n\r\n`;
const hidden = `GET /v1/worlds HTTP/1.1\r\n${host}\r\n`;
const chunkedHidden = `0\r\n\r\n${hidden}`;
/// A request of /healthz with these fields, and what follows its head.
const get = (fields, rest = '') => `GET /healthz HTTP/1.1\r\n${host}${fields}\r\n${rest}`;
const line = (text) => `${text}\r\n${host}\r\n`;
const both = (coding, length = 4) => get(`Content-Length: ${length}\r\nTransfer-Encoding: ${coding}\r\n`, chunkedHidden);
const coded = (field, body = chunkedHidden) => get(`${field}\r\n`, body);
const sized = (value, body = hidden) => get(`Content-Length: ${value}\r\n`, body);

const corpus = {
  'two good requests': get('') + hidden,
  'three, the first of which closes': get('Connection: close\r\n') + hidden + hidden,
  'a body that is a request': sized(hidden.length),
  'a body of nothing': sized(0, hidden),
  'a length and a coding': both('chunked'),
  'a length of all and a coding': both('chunked', chunkedHidden.length),
  'a coding before a length': get(`Transfer-Encoding: chunked\r\nContent-Length: ${chunkedHidden.length}\r\n`, chunkedHidden),
  'a coding alone': coded('Transfer-Encoding: chunked'),
  'a coding in capitals': coded('TRANSFER-ENCODING: CHUNKED'),
  'a coding with a tab': coded('Transfer-Encoding:\tchunked'),
  'a coding with a blank before the colon': coded('Transfer-Encoding : chunked'),
  'a coding with a vertical tab': coded('Transfer-Encoding: \x0bchunked'),
  'a coding with a NUL': coded('Transfer-Encoding: chunked\0'),
  'a coding that is none': coded('Transfer-Encoding: xchunked'),
  'identity': coded('Transfer-Encoding: identity', hidden),
  'chunked, then identity': coded('Transfer-Encoding: chunked, identity'),
  'identity, then chunked': coded('Transfer-Encoding: identity, chunked'),
  'chunked twice': coded('Transfer-Encoding: chunked, chunked'),
  'two codings in two fields': coded('Transfer-Encoding: chunked\r\nTransfer-Encoding: x'),
  'an empty coding': coded('Transfer-Encoding:', hidden),
  'a folded coding': coded('Transfer-Encoding:\r\n chunked'),
  'a coding in a folded line': coded('X: y\r\n Transfer-Encoding: chunked'),
  'a coding behind a bare line feed': coded('X: y\nTransfer-Encoding: chunked'),
  'a coding behind a bare return': coded('X: y\rTransfer-Encoding: chunked'),
  'a coding with an underscore': coded('Transfer_Encoding: chunked', hidden),
  'a quoted coding': coded('Transfer-Encoding: "chunked"'),
  'a coding of HTTP/1.0': `GET /healthz HTTP/1.0\r\n${host}Transfer-Encoding: chunked\r\n\r\n${chunkedHidden}`,
  'a chunk with an extension': coded('Transfer-Encoding: chunked', `1;a=b\r\nx\r\n${chunkedHidden}`),
  'a chunk with a line feed in its extension': coded('Transfer-Encoding: chunked', `1;a\nx\r\n${chunkedHidden}`),
  'a chunk of 2^64': coded('Transfer-Encoding: chunked', `10000000000000000\r\n${hidden}`),
  'a chunk of a negative size': coded('Transfer-Encoding: chunked', `-1\r\n${hidden}`),
  'a chunk whose size is 0x1': coded('Transfer-Encoding: chunked', `0x1\r\nx\r\n${chunkedHidden}`),
  'a trailer with a length': coded('Transfer-Encoding: chunked', `0\r\nContent-Length: ${hidden.length}\r\n\r\n${hidden}`),
  'two equal lengths': get(`Content-Length: 4\r\nContent-Length: 4\r\n`, `abcd${hidden}`),
  'two unequal lengths': get(`Content-Length: 0\r\nContent-Length: ${hidden.length}\r\n`, hidden),
  'a list of lengths': sized(`0, ${hidden.length}`),
  'a length with a plus': sized(`+${hidden.length}`),
  'a length with a minus': sized('-0'),
  'a length in hexadecimal': sized(`0x${hidden.length.toString(16)}`),
  'a length with zeros before it': sized(`000${hidden.length}`),
  'a length with blanks': sized(` ${hidden.length} \t`),
  'a length with a blank inside': sized(`${String(hidden.length)[0]} ${String(hidden.length).slice(1)}`),
  'a length of 2^64': sized('18446744073709551616'),
  'an empty length': sized(''),
  'a length in a folded line': get(`X: y\r\n Content-Length: ${hidden.length}\r\n`, hidden),
  'a length with a blank before the colon': get(`Content-Length : ${hidden.length}\r\n`, hidden),
  'a length that Connection names': get(`Connection: Content-Length\r\nContent-Length: ${hidden.length}\r\n`, hidden),
  'a body that waits to be asked for': get(`Expect: 100-continue\r\nContent-Length: ${hidden.length}\r\n`, hidden),
  'lines that end in line feeds': `GET /healthz HTTP/1.1\nHost: a\n\n${hidden}`,
  'a head that ends in a line feed': `GET /healthz HTTP/1.1\r\n${host}\n${hidden}`,
  'a head that ends in returns': `GET /healthz HTTP/1.1\r\n${host}\r\r${hidden}`,
  'an empty line first': `\r\n${get('')}`,
  'a blank line first': ` \r\n${get('')}`,
  'a blank before the first field': `GET /healthz HTTP/1.1\r\n ${host}\r\n`,
  'a field without a colon': get('X\r\n'),
  'a field without a name': get(': x\r\n'),
  'a NUL in a field': get('X: a\0b\r\n'),
  'a body in HTTP/0.9': 'GET /healthz\r\n\r\n',
  'no host': 'GET /healthz HTTP/1.1\r\n\r\n',
  'two hosts': get('Host: b\r\n'),
  'another host in the target': line('GET http://b/healthz HTTP/1.1'),
  'a list of hosts': `GET /healthz HTTP/1.1\r\nHost: a, b\r\n\r\n`,
  'a fragment': line('GET /healthz#/x HTTP/1.1'),
  'two blanks in the first line': line('GET  /healthz HTTP/1.1'),
  'a blank in the target': line('GET /healthz x HTTP/1.1'),
  'a tab in the first line': line('GET\t/healthz HTTP/1.1'),
  'a blank behind the version': line('GET /healthz HTTP/1.1 '),
  'a version of 1.10': line('GET /healthz HTTP/1.10'),
  'a version of 2.0': line('GET /healthz HTTP/2.0'),
  'a method in small letters': line('get /healthz HTTP/1.1'),
  'HEAD with a body': `HEAD /healthz HTTP/1.1\r\n${host}Content-Length: ${hidden.length}\r\n\r\n${hidden}`,
  'POST with a body': `POST /v1/worlds HTTP/1.1\r\n${host}Content-Length: ${hidden.length}\r\n\r\n${hidden}`,
  'an upgrade to h2c': get('Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n') + hidden,
  'half an upgrade to WebSocket': line('GET /v1/worlds/default/stream HTTP/1.1') + hidden,
};

/// What was made of it: the statuses in order, up to the one that ended the connection; `isRefused` if what came behind
/// the first request was not read.
function reading(answers) {
  const isRefused = !answers.some(({ body }) => body.includes('there is nothing of that name here'));
  return { statuses: answers.map(({ status }) => status), isRefused };
}

const limits = ['--head-s', '2', '--idle-s', '2', '--silent-s', '2'];

for (const name of Object.keys(proxies)) {
  const isThere = proxies[name].isThere();
  test(`${name} in front reads requests as talusd does`, { skip: isThere ? false : `${name} is not installed: tests/run --all fetches it` }, async (t) => {
    const server = await startServer(limits);
    t.after(() => server.stop());
    const tap = await startTap(t, server.ready.http);
    const proxy = await startProxy(t, name, tap.at);
    const given = () => tap.heard.flatMap(answersIn).length;
    const told = [];
    for (const [what, bytes] of Object.entries(corpus)) {
      const sent = [Buffer.from(bytes + last, 'latin1')];
      const before = given();
      const [alone, through] = await Promise.all([
        speak(server.ready.http, sent, { linger: false }),
        speak(proxy.at, sent, { linger: false }),
      ]);
      const direct = reading(answersIn(alone.heard));
      const answers = answersIn(through.heard);
      const proxied = reading(answers);
      told.push(`${what}: ${direct.statuses} alone, ${proxied.statuses} through ${name}`);

      // What talusd read out of the proxy's connection is what the proxy put there, and no answer is left over.
      const passedOn = answers.filter(({ status, server, body }) => server === 'talus' || (status === 0 && body !== '')).length;
      assert.equal(given() - before, passedOn, `${what}: talusd's answers, and those that ${name} passed on`);
      // What talusd alone takes for good, the proxy refuses or takes for the same.
      if (!direct.isRefused && !proxied.isRefused) assert.deepEqual(proxied.statuses, direct.statuses, what);
      // Whoever comes next gets an answer of his own.
      const next = await request(proxy.at, '/v1/worlds');
      assert.equal(next.status, 200, what);
      assert.match(next.body.toString(), /"default"/, what);
    }
    t.diagnostic(told.join('\n'));
  });
}

test('talusd alone answers a request that declares a body, in whatever way, and reads nothing behind it', async (t) => {
  const server = await startServer(limits);
  t.after(() => server.stop());
  const declaresBody = /^[ \t]*(content-length[ \t]*:[ \t]*[^0\s]|transfer-encoding[ \t]*:)/im;
  const declaring = Object.entries(corpus).filter(([, bytes]) => declaresBody.test(bytes.slice(0, bytes.indexOf('\r\n\r\n'))));
  assert.ok(declaring.length > 40, `${declaring.length} of the corpus`);
  for (const [what, bytes] of declaring) {
    const { heard } = await speak(server.ready.http, [Buffer.from(bytes + last, 'latin1')], { linger: false });
    const { statuses } = reading(answersIn(heard));
    assert.equal(statuses.length, 1, `${what}: ${statuses}`);
    assert.ok(statuses[0] >= 400, `${what}: ${statuses}`);
  }
});
