#!/usr/bin/env python3
"""Checks JSON against a schema: types, ranges, required keys, and that the schema names every key where it stands.

    validate.py SCHEMA <PAIRS      PAIRS: [[DEFINITION, JSON], ..]; DEFINITION "" is the whole schema

Prints what is wrong. Exit code: the number of invalid values, at most 76; 77: python3-jsonschema is not
installed."""

import json
import os
import sys

try:
    from jsonschema import Draft202012Validator
except ImportError:
    debian = '/usr/bin/python3'  # may have the package when another python3 is in front of it
    if os.path.exists(debian) and os.path.realpath(sys.executable) != os.path.realpath(debian):
        os.execv(debian, [debian, *sys.argv])
    sys.exit(77)


def closed(schema, whole=True):
    """The schema without unknown keys. `whole`: it describes an object alone, rather than with a sibling of
    allOf or oneOf, so it must know all keys."""
    if not isinstance(schema, dict):
        return schema
    result = {key: value for key, value in schema.items() if key != '$schema'}
    for key, value in schema.items():
        if key in ('properties', 'definitions'):
            result[key] = {name: closed(part, key == 'properties') for name, part in value.items()}
        elif key in ('items', 'additionalProperties'):
            result[key] = closed(value)
        elif key in ('if', 'then', 'else', 'not'):
            result[key] = closed(value, False)
        elif key in ('allOf', 'anyOf', 'oneOf'):
            result[key] = [closed(part, False) for part in value]
    return {**result, 'unevaluatedProperties': False} if whole else result


with open(sys.argv[1]) as file:
    schema = json.load(file)
wrong = 0
for definition, instance in json.load(sys.stdin):
    root = closed(schema)
    if definition:
        root = {'$ref': f'#/definitions/{definition}', 'definitions': root['definitions'], 'unevaluatedProperties': False}
    errors = list(Draft202012Validator(root).iter_errors(instance))
    for error in errors:
        print(f'{definition or "root"}: {"/".join(map(str, error.absolute_path))}: {error.message[:300]}')
    wrong += len(errors) > 0
sys.exit(min(wrong, 76))
