// The frame of a program: flags in, one line on stderr for what the user can mend.

import { parseArgs } from "node:util";

/** What went wrong, in words for the user. Other errors are bugs or damaged input. */
export class UserError extends Error {}

/** Wrong flags: status 2, as the C++ programs have it. */
class UsageError extends Error {}

/**
 * Runs `body(flags, positional)` and ends the process: status 0, 1 (an error of `body`) or 2 (flags).
 *
 * @param {{name: string, usage: string, options: object, numPositional: number, required: string[]}} command
 *     `options` as node's parseArgs takes them; minPositional instead of numPositional takes more files too.
 */
export async function runCommand(command, body) {
  // Ends by way of process "exit": who has an unfinished file removes it there.
  for (const [signal, number] of [["SIGINT", 2], ["SIGTERM", 15], ["SIGHUP", 1]]) {
    process.once(signal, () => process.exit(128 + number));
  }
  try {
    const { values, positionals } = parse(command);
    if (values.help) {
      process.stdout.write(`${command.usage}\n`);
      return;
    }
    requireAll(command, values, positionals);
    await body(values, positionals);
  } catch (error) {
    // One line whatever a library put into its message.
    process.stderr.write(`${command.name}: ${String(error.message).replace(/\s*\n\s*/g, "; ")}\n`);
    process.exitCode = error instanceof UsageError ? 2 : 1;
  }
}

function parse(command) {
  try {
    return parseArgs({
      options: { ...command.options, help: { type: "boolean", short: "h" } },
      allowPositionals: true,
    });
  } catch (error) {
    throw new UsageError(`${error.message} (--help lists the flags)`);
  }
}

function requireAll(command, values, positionals) {
  const num = positionals.length;
  const { numPositional: wanted, minPositional: least } = command;
  if (num !== (wanted ?? num) || num < (least ?? 0)) {
    throw new UsageError(`wants ${wanted ?? `at least ${least}`} file, got ${num} (--help lists the flags)`);
  }
  for (const flag of command.required) {
    if (values[flag] === undefined) {
      throw new UsageError(`--${flag} is required (--help lists the flags)`);
    }
  }
}
