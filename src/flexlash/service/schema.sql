-- What the store knows of submissions. Times are seconds since 1970. PRAGMA user_version is the version of this schema.
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;

CREATE TABLE submission (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  size INTEGER NOT NULL,
  options TEXT NOT NULL,
  door TEXT NOT NULL,
  sender TEXT NOT NULL,
  received_at REAL NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('waiting', 'working', 'done', 'rejected')),
  tries INTEGER NOT NULL DEFAULT 0,
  alone INTEGER NOT NULL DEFAULT 0,
  server_ends INTEGER NOT NULL DEFAULT 0,
  not_before REAL NOT NULL DEFAULT 0,
  trouble TEXT NOT NULL DEFAULT '',
  began_at REAL,
  ended_at REAL,
  rows_done INTEGER NOT NULL DEFAULT 0,
  rows INTEGER NOT NULL DEFAULT 0,
  exit_code INTEGER,
  words TEXT NOT NULL DEFAULT '',
  reason TEXT NOT NULL DEFAULT '',
  same_as TEXT NOT NULL DEFAULT '',
  counts TEXT NOT NULL DEFAULT '{}',
  is_repeatable INTEGER NOT NULL DEFAULT 1
) STRICT;
CREATE INDEX submission_by_state ON submission (state, number);
CREATE INDEX submission_by_content ON submission (sha256, name, options);
CREATE INDEX submission_by_end ON submission (ended_at);
CREATE INDEX submission_by_repeat ON submission (same_as) WHERE same_as <> '';
CREATE INDEX submission_by_name ON submission (name, number);

CREATE TABLE file (
  submission TEXT NOT NULL REFERENCES submission (id) ON DELETE CASCADE,
  role TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  size INTEGER NOT NULL,
  name TEXT NOT NULL,
  PRIMARY KEY (submission, role)
) STRICT;
CREATE INDEX file_by_content ON file (sha256);

CREATE TABLE rule (
  submission TEXT NOT NULL REFERENCES submission (id) ON DELETE CASCADE,
  level TEXT NOT NULL,
  code TEXT NOT NULL,
  sheet TEXT NOT NULL,
  "column" TEXT NOT NULL,
  cells INTEGER NOT NULL,
  first TEXT NOT NULL
) STRICT;
CREATE INDEX rule_by_submission ON rule (submission);

CREATE TABLE delivery (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  submission TEXT NOT NULL REFERENCES submission (id) ON DELETE CASCADE,
  kind TEXT NOT NULL,
  role TEXT NOT NULL DEFAULT '',
  target TEXT NOT NULL DEFAULT '',
  is_done INTEGER NOT NULL DEFAULT 0,
  tries INTEGER NOT NULL DEFAULT 0,
  not_before REAL NOT NULL DEFAULT 0,
  trouble TEXT NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX delivery_by_state ON delivery (is_done, submission);
CREATE INDEX delivery_by_submission ON delivery (submission, kind);

CREATE TABLE event (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  at REAL NOT NULL,
  kind TEXT NOT NULL,
  submission TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT;
CREATE INDEX event_by_submission ON event (submission, number);

CREATE TABLE forgotten (id TEXT PRIMARY KEY, at REAL NOT NULL) STRICT;
