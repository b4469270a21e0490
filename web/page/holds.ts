// The condition of a challenge: clauses joined by "and", each a verdict of the widget, or a comparison of facts,
// parameters and numbers. `tests/pinned/page/challenges.rs` reads the same grammar.

import type { Outcome } from '../ts/instance';
import type { Value } from '../ts/values';

/** Whether a result at these parameters meets the condition. */
export function holds(condition: string, outcome: Outcome, values: Record<string, Value>): boolean {
  return condition.split(' and ').every((clause) => clauseHolds(clause, outcome, values));
}

function clauseHolds(clause: string, { verdict, facts }: Outcome, values: Record<string, Value>): boolean {
  const [left = '', sign, right = ''] = clause.split(' ');
  const value = (name: string): Value => facts[name] ?? values[name] ?? (name in facts ? NaN : name);
  switch (sign) {
    case '<':
      return Number(value(left)) < Number(value(right));
    case '>':
      return Number(value(left)) > Number(value(right));
    case '=':
      return String(value(left)) === right;
    default:
      return clause.startsWith('not ') ? verdict !== clause.slice(4) : verdict === clause;
  }
}
