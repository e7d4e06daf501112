import { expect, test } from 'vitest';
import { authorization, tokenOf } from '../../src/protocol/join_token';

test('a token is read from the query of the page', () => {
  expect(tokenOf('?at=1,2,3&token=aaa.bbb.ccc&hud=0')).toBe('aaa.bbb.ccc');
  expect(tokenOf('?at=1,2,3')).toBe('');
});

test('a request without a token has no field for one', () => {
  expect(authorization('')).toEqual({});
  expect(authorization('aaa.bbb.ccc')).toEqual({ Authorization: 'Bearer aaa.bbb.ccc' });
});
