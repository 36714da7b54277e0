// What SheetJS or exceljs reads in a workbook: {sheet: {address: [kind, value, whether a formula]}}.
// Kinds are number, text, boolean, error and nothing; a date is the number that it is stored as.
// usage: node other_readers.cjs SheetJS|exceljs FOLDER-OF-PACKAGES WORKBOOK…

const path = require("node:path");
const [, , reader, packages, ...workbooks] = process.argv;
const load = (name) => require(path.join(packages, "node_modules", name));

function bySheetJS(file) {
  const XLSX = load("xlsx");
  const book = XLSX.readFile(file, { cellFormula: true, cellDates: false, cellText: false, cellHTML: false, sheetStubs: true });
  const kinds = { n: "number", s: "text", b: "boolean", e: "error" };
  const sheets = {};
  for (const name of book.SheetNames) {
    sheets[name] = {};
    for (const [address, cell] of Object.entries(book.Sheets[name])) {
      if (address.startsWith("!")) continue;
      const isFormula = cell.f !== undefined;
      if (cell.t === "z" && !isFormula) continue;
      const value = cell.t === "e" ? ERRORS[cell.v] : cell.v;
      sheets[name][address] = cell.t === "z" ? ["nothing", null, true] : [kinds[cell.t], value, isFormula];
    }
  }
  return sheets;
}

const ERRORS = { 0: "#NULL!", 7: "#DIV/0!", 15: "#VALUE!", 23: "#REF!", 29: "#NAME?", 36: "#NUM!", 42: "#N/A" };
const DAYS_BEFORE_1970 = 25569;
const MILLISECONDS_OF_A_DAY = 86400000;

function kindAndValue(value) {
  if (value === null || value === undefined) return ["nothing", null];
  if (value instanceof Date) return ["number", DAYS_BEFORE_1970 + value.getTime() / MILLISECONDS_OF_A_DAY];
  if (value.richText) return ["text", value.richText.map((piece) => piece.text).join("")];
  if (value.error) return ["error", value.error];
  if (value.hyperlink !== undefined) return kindAndValue(value.text);
  return [{ number: "number", string: "text", boolean: "boolean" }[typeof value], value];
}

async function byExceljs(file) {
  const book = new (load("exceljs").Workbook)();
  await book.xlsx.readFile(file);
  const sheets = {};
  book.eachSheet((sheet) => {
    const cells = (sheets[sheet.name] = {});
    sheet.eachRow((row) =>
      row.eachCell((cell) => {
        const value = cell.value;
        const isFormula = Boolean(value && (value.formula !== undefined || value.sharedFormula !== undefined));
        if (cell.isMerged && cell.master !== cell) return;
        // The value of a formula leaves out a result of 0, which the cell itself has.
        cells[cell.address] = [...kindAndValue(isFormula ? cell.result : value), isFormula];
      }),
    );
  });
  return sheets;
}

async function main() {
  for (const file of workbooks) {
    const sheets = reader === "SheetJS" ? bySheetJS(file) : await byExceljs(file);
    process.stdout.write(JSON.stringify(sheets) + "\n");
  }
}

main();
