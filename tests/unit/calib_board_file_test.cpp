#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "calib/board.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::calib {
namespace {

using testing::HasSubstr;

class BoardFileTest : public testing::Test {
 protected:
    [[nodiscard]] std::filesystem::path File() const { return folder_ / "board.yaml"; }
    [[nodiscard]] std::string ErrorOf(const std::string& text) const {
        std::ofstream(File()) << text;
        const ParsedBoard parsed = LoadBoard(File());
        EXPECT_NE(parsed.board.has_value(), !parsed.error.empty());
        return parsed.error;
    }
    tests::TemporaryFolder folder_;
};

TEST_F(BoardFileTest, EveryBoardReadsBackAsItWasWritten) {
    const Board boards[] = {{.columns = 9, .rows = 6, .square_m = 0.1 / 3},
                            {.columns = 10,
                             .rows = 7,
                             .square_m = 0.04,
                             .pattern = Pattern::kCharuco,
                             .tag_m = 0.028,
                             .first_tag = 12},
                            {.columns = 1,
                             .rows = 1,
                             .square_m = 0.5,
                             .pattern = Pattern::kTags,
                             .tag_m = 0.4,
                             .first_tag = 586}};
    for (const Board& board : boards) {
        ASSERT_EQ(SaveBoard(board, File()), "");
        const ParsedBoard read = ReadBoard(File().string());
        ASSERT_TRUE(read.board) << read.error;
        EXPECT_EQ(*read.board, board);
    }
}

TEST_F(BoardFileTest, MistakesAreNamedWithTheirLines) {
    const std::string good = "schema: 1\npattern: tags\ncolumns: 6\nrows: 6\nsquare_m: 0.1\n";
    EXPECT_THAT(ErrorOf(good), HasSubstr("tag_m is missing"));
    EXPECT_THAT(ErrorOf(good + "tag_m: 0.1\n"), HasSubstr("board.yaml:6: tag_m is 0.1, must be"));
    EXPECT_THAT(ErrorOf(good + "tag_m: 0.08\nfirst_tag: 552\n"),
                HasSubstr(":7: first_tag is 552, must be 0 to 551"));
    EXPECT_THAT(ErrorOf(good + "tag_m: 0.08\ncolour: red\n"), HasSubstr("colour is no key"));
    EXPECT_THAT(ErrorOf("schema: 1\npattern: squares\ncolumns: 6\nrows: 6\nsquare_m: 0.1\n"),
                HasSubstr(":2: pattern is squares, must be one of checkerboard, charuco, tags"));
    EXPECT_THAT(
        ErrorOf("schema: 1\npattern: checkerboard\ncolumns: 9\nrows: 6\nsquare_m: 0.1\ntag_m: 1\n"),
        HasSubstr("tag_m is no key"));
}

TEST_F(BoardFileTest, AFileThatIsNotThereIsNamed) {
    EXPECT_THAT(ReadBoard("nowhere/board.yaml").error, HasSubstr("nowhere/board.yaml"));
    EXPECT_THAT(ReadBoard("nine by six").error, HasSubstr("or a board file"));
    EXPECT_TRUE(ReadBoard("9x6,0.025").board);
}

}  // namespace
}  // namespace hitchview::calib
